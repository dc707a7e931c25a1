use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::sync::{Arc, Mutex};

use glam::Vec3;

use super::api::{Api, FLOAT3, Handle, INDICES, TRIANGLES, UINT3, VERTICES, api};
use crate::accel::BuildError;
use crate::geometry::Mesh;

#[derive(Default)]
struct Monitor {
    error: Mutex<Option<String>>,
    bytes: AtomicIsize,
}

pub struct Scene {
    pub(super) api: &'static Api,
    device: Handle,
    pub(super) handle: Handle,
    /// Embree stores a pointer to the monitor. Moving the `Arc` keeps this pointer valid.
    monitor: Arc<Monitor>,
}

// SAFETY: any thread may use and release objects of Embree.
unsafe impl Send for Scene {}
// SAFETY: many threads may query a committed scene at once. `Monitor` contains only an atomic and a lock.
unsafe impl Sync for Scene {}

/// # Safety
/// `monitor` must point to a live `Monitor`. `text` must be null or point to a C string.
unsafe extern "C" fn on_error(monitor: *mut c_void, _: c_int, text: *const c_char) {
    // SAFETY: by the contract of this function the monitor lives.
    let monitor = unsafe { &*monitor.cast::<Monitor>() };
    let sentence = if text.is_null() {
        "it gives no reason".into()
    } else {
        // SAFETY: `text` is not null. By the contract of this function `text` points to a C string.
        unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
    };
    if let Ok(mut error) = monitor.error.lock() {
        error.get_or_insert(sentence);
    }
}

/// # Safety
/// `monitor` must point to a live `Monitor`.
unsafe extern "C" fn on_memory(monitor: *mut c_void, bytes: isize, _: bool) -> bool {
    // SAFETY: by the contract of this function the monitor lives.
    unsafe { &*monitor.cast::<Monitor>() }.bytes.fetch_add(bytes, Ordering::Relaxed);
    true
}

impl Scene {
    /// `device` is the configuration for `rtcNewDevice`.
    pub fn new(mesh: &Mesh, ids: &[u32], flags: c_int, quality: c_int, device: &str) -> Result<Self, BuildError> {
        let api = api().map_err(BuildError::Unavailable)?;
        let options = CString::new(device).expect("the configuration contains no zero byte");
        // SAFETY: the order of the calls follows Embree's manual. `scene` owns the registered monitor. `Scene::drop`
        // releases the device before the monitor is dropped.
        unsafe {
            let device = (api.new_device)(options.as_ptr());
            if device.is_null() {
                let code = (api.device_error)(std::ptr::null_mut());
                return Err(BuildError::Unavailable(format!("Embree could not create a device (error {code})")));
            }
            let monitor: Arc<Monitor> = Arc::default();
            let listener = Arc::as_ptr(&monitor).cast_mut().cast();
            (api.on_error)(device, on_error, listener);
            (api.on_memory)(device, on_memory, listener);

            let scene = Self { api, device, handle: (api.new_scene)(device), monitor };
            (api.set_scene_flags)(scene.handle, flags);
            (api.set_scene_quality)(scene.handle, quality);
            if !ids.is_empty() {
                scene.attach(mesh, ids, quality)?;
            }
            (api.commit_scene)(scene.handle);
            scene.refusal().map_or(Ok(scene), Err)
        }
    }

    /// Embree allocates, pads and aligns the buffers.
    fn attach(&self, mesh: &Mesh, ids: &[u32], quality: c_int) -> Result<(), BuildError> {
        let (api, positions) = (self.api, mesh.positions());
        // SAFETY: the null check precedes all writes to the buffers. `vertices` has space for all `positions`.
        // `indices` has space for one triangle per id. The scene keeps a reference to the attached geometry.
        unsafe {
            let geometry = (api.new_geometry)(self.device, TRIANGLES);
            let vertices: *mut Vec3 = (api.new_buffer)(geometry, VERTICES, 0, FLOAT3, 12, positions.len()).cast();
            let indices: *mut [u32; 3] = (api.new_buffer)(geometry, INDICES, 0, UINT3, 12, ids.len()).cast();
            if vertices.is_null() || indices.is_null() {
                (api.release_geometry)(geometry);
                return Err(self.refusal().unwrap_or(BuildError::Mesh("Embree could not allocate a buffer".into())));
            }
            vertices.copy_from_nonoverlapping(positions.as_ptr(), positions.len());
            for (i, &id) in ids.iter().enumerate() {
                indices.add(i).write(mesh.triangles()[id as usize]);
            }
            (api.set_geometry_quality)(geometry, quality);
            (api.commit_geometry)(geometry);
            (api.attach_geometry)(self.handle, geometry);
            (api.release_geometry)(geometry);
        }
        Ok(())
    }

    fn refusal(&self) -> Option<BuildError> {
        let error = self.monitor.error.lock().ok()?.take()?;
        Some(BuildError::Mesh(format!("Embree reports an error: {error}")))
    }

    /// All memory of the device, in bytes.
    pub fn bytes(&self) -> usize {
        self.monitor.bytes.load(Ordering::Relaxed).max(0) as usize
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: `new` has created the scene and the device. Only `drop` releases the scene and the device. The
        // monitor is dropped later.
        unsafe {
            (self.api.release_scene)(self.handle);
            (self.api.release_device)(self.device);
        }
    }
}
