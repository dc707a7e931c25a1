//! The SIMD instruction set, selected at run time.

use std::fmt::{self, Display};
use std::str::FromStr;
use std::sync::atomic::{AtomicU8, Ordering};

#[cfg(target_arch = "x86_64")]
use super::avx::Avx;
use super::{EightLanes, Portable};

/// A SIMD instruction set.
///
/// Searches find the same hits at every level, bit for bit.
///
/// A level is proof that the machine has the instructions, so [`dispatch`] needs no check. The machine may lack `Avx2`
/// and `Avx512`. Other crates cannot construct these levels:
///
/// ```compile_fail,E0603
/// let level = sahara_core::simd::Level::Avx512;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Level {
    /// Scalar code over arrays.
    Portable,
    /// AVX2, FMA, BMI1, BMI2, LZCNT and POPCNT.
    #[non_exhaustive]
    Avx2,
    /// AVX-512 F, AVX-512 VL and the instructions of `Avx2`.
    #[non_exhaustive]
    Avx512,
}

/// An unknown level, or a level that this machine or build lacks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("level {name:?} is not available on this processor or in this build; available: {known}")]
pub struct UnknownLevel {
    name: String,
    known: String,
}

/// A computation over eight lanes, compiled for each level.
pub trait Kernel {
    /// The result of the computation.
    type Output;

    /// Runs the computation on lanes of type `L`.
    ///
    /// This function and all functions over `L` lanes must be `#[inline(always)]`. Only inlined code is compiled for
    /// the instructions of `L`.
    fn run<L: EightLanes>(self) -> Self::Output;
}

static CURRENT: AtomicU8 = AtomicU8::new(UNCHOSEN);
const UNCHOSEN: u8 = u8::MAX;

/// Each level adds a compiled copy of every kernel. Without the feature `all-levels`, a build for AVX-512 omits `Avx2`,
/// and a build for AVX2 without AVX-512 omits `Avx512`.
const WITH_AVX2: bool =
    cfg!(all(target_arch = "x86_64", any(feature = "all-levels", not(target_feature = "avx512vl"))));
const WITH_AVX512: bool = cfg!(all(
    target_arch = "x86_64",
    any(feature = "all-levels", target_feature = "avx512vl", not(target_feature = "avx2"))
));

impl Level {
    const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// The name on the command line and in exports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The levels that this machine and this build have, in ascending order.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|level| level.is_available()).collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn is_available(self) -> bool {
        // These checks must cover all features that the functions `avx2` and `avx512` enable.
        let bits = is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        let avx2 = bits && is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        let masks = || is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl");
        match self {
            Self::Portable => true,
            Self::Avx2 => WITH_AVX2 && avx2,
            Self::Avx512 => WITH_AVX512 && avx2 && masks(),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn is_available(self) -> bool {
        self == Self::Portable
    }

    /// The level of the whole process. The default is the highest available level.
    #[inline(always)]
    pub fn current() -> Self {
        match CURRENT.load(Ordering::Relaxed) {
            0 => Self::Portable,
            1 => Self::Avx2,
            2 => Self::Avx512,
            _ => Self::choose_highest(),
        }
    }

    #[cold]
    fn choose_highest() -> Self {
        let highest = *Self::available().last().expect("the portable level is always available");
        highest.choose();
        highest
    }

    /// Sets the level of the whole process.
    ///
    /// # Panics
    /// If the level is not available.
    pub fn choose(self) {
        assert!(self.is_available(), "the level {self} is not available");
        CURRENT.store(self as u8, Ordering::Relaxed);
    }
}

impl Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Level {
    type Err = UnknownLevel;

    fn from_str(name: &str) -> Result<Self, UnknownLevel> {
        let known = Self::available();
        known.iter().copied().find(|level| level.name() == name).ok_or_else(|| UnknownLevel {
            name: name.into(),
            known: known.iter().map(|level| level.name()).collect::<Vec<_>>().join(", "),
        })
    }
}

/// Runs `kernel` compiled for `level`.
///
/// # Panics
/// In debug builds, if the level is not available.
#[inline(always)]
pub fn dispatch<K: Kernel>(level: Level, kernel: K) -> K::Output {
    debug_assert!(level.is_available());
    match level {
        // SAFETY: the machine has the instructions. Other crates cannot construct this level. Callers obtain it only
        // from `available` or `current`, which return it only after `is_available` has detected the instructions.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 if WITH_AVX2 => unsafe { avx2(kernel) },
        // SAFETY: the machine has the instructions, as for `Avx2`.
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 if WITH_AVX512 => unsafe { avx512(kernel) },
        _ => kernel.run::<Portable<8>>(),
    }
}

// Not inlined, to give each kernel a separate stack frame.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx<false>>()
}

#[cfg(target_arch = "x86_64")]
#[inline(never)]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx<true>>()
}
