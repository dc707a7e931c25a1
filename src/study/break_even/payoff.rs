use serde::Serialize;

use crate::report::number::figures;

/// When a dearer build pays, the sooner first.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Payoff {
    /// Before the first ray: the build is not dearer after all, and the rays are faster.
    AtOnce,
    /// After so many rays.
    Rays(f64),
    /// Not at all: the rays are not faster.
    Never,
}

impl Payoff {
    /// Of the build and the time of a ray, both in the same unit, of the cheap and of the dear structure.
    pub fn of(cheap: (f64, f64), dear: (f64, f64)) -> Self {
        let (dearer, faster) = (dear.0 - cheap.0, cheap.1 - dear.1);
        if faster <= 0.0 {
            Self::Never
        } else if dearer <= 0.0 {
            Self::AtOnce
        } else {
            Self::Rays(dearer / faster)
        }
    }

    /// For machines.
    pub fn plain(self) -> String {
        match self {
            Self::Rays(rays) => format!("{rays:.1}"),
            other => other.words(),
        }
    }

    /// For people: rays as thousands, millions or thousands of millions.
    pub fn words(self) -> String {
        match self {
            Self::AtOnce => "at once".into(),
            Self::Never => "never".into(),
            Self::Rays(rays) if rays < 999.5 => figures(rays),
            Self::Rays(rays) if rays < 999.5e3 => format!("{}k", figures(rays / 1e3)),
            Self::Rays(rays) if rays < 999.5e6 => format!("{}M", figures(rays / 1e6)),
            Self::Rays(rays) => format!("{}G", figures(rays / 1e9)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dearer_build_pays_when_its_rays_have_saved_the_difference() {
        assert_eq!(Payoff::of((10.0, 3.0), (110.0, 1.0)), Payoff::Rays(50.0));
        assert_eq!(Payoff::of((10.0, 3.0), (110.0, 3.0)), Payoff::Never);
        assert_eq!(Payoff::of((10.0, 3.0), (5.0, 1.0)), Payoff::AtOnce);
        assert_eq!(Payoff::of((10.0, 3.0), (5.0, 4.0)), Payoff::Never);
    }

    #[test]
    fn the_order_is_that_of_waiting() {
        let mut payoffs = [Payoff::Never, Payoff::Rays(5.0), Payoff::AtOnce, Payoff::Rays(2.0)];
        payoffs.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(payoffs, [Payoff::AtOnce, Payoff::Rays(2.0), Payoff::Rays(5.0), Payoff::Never]);
        assert_eq!(payoffs.map(Payoff::words), ["at once", "2.00", "5.00", "never"]);
        let words = [1234.0, 9.996e5, 2.5e6, 4e9].map(|rays| Payoff::Rays(rays).words());
        assert_eq!(words, ["1.23k", "1.00M", "2.50M", "4.00G"]);
    }

    #[test]
    fn all_of_them_are_read_by_machines() {
        let text = serde_json::to_string(&[Payoff::AtOnce, Payoff::Rays(2.5), Payoff::Never]).unwrap();
        assert_eq!(text, r#"["at-once",{"rays":2.5},"never"]"#);
    }
}
