use crate::accel::DynAccel;
use crate::geometry::Ray;

/// Depth complexity: the mean number of surfaces that rays meet within their intervals, as `accel` finds them one behind another.
/// Surfaces at the same `t` count once. Nothing without rays.
pub fn complexity(accel: &dyn DynAccel, rays: &[Ray]) -> Option<f64> {
    let (mut met, mut going) = (0u64, rays.to_vec());
    while !going.is_empty() {
        let hits = accel.closest(&going);
        let beyond =
            going.iter().zip(&hits).filter_map(|(ray, hit)| Some(Ray { t_min: hit.as_ref()?.t.next_up(), ..*ray }));
        going = beyond.collect();
        met += going.len() as u64;
    }
    (!rays.is_empty()).then(|| met as f64 / rays.len() as f64)
}
