//! The instruction set of a batch, selected at run time.

use std::fmt::{self, Display};
use std::str::FromStr;
use std::sync::atomic::{AtomicU8, Ordering};

#[cfg(target_arch = "x86_64")]
use super::avx::Avx;
use super::{EightLanes, Portable};

/// An instruction set that lanes are compiled for. All sets return the same hits, bit for bit.
///
/// A level is proof that the machine has its instructions, so [`dispatch`] needs no check. Other crates cannot
/// construct a level that a machine may lack; they get levels from [`Level::available`], [`Level::current`] or a name.
///
/// ```compile_fail,E0603
/// let level = sahara_core::simd::Level::Avx512;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Level {
    /// Scalar code over arrays, which the compiler may vectorise.
    Portable,
    /// AVX2, FMA and the bit instructions of the same generation (x86-64-v3).
    #[non_exhaustive]
    Avx2,
    /// The instructions of `Avx2`, and AVX-512 F and VL, which compress lanes in one step.
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

/// A computation that is written once over eight lanes and runs on any level.
pub trait Kernel {
    /// The result.
    type Output;

    /// Must be `#[inline(always)]`, like the functions on lanes that it calls: only inlined code is compiled for `L`.
    fn run<L: EightLanes>(self) -> Self::Output;
}

static CURRENT: AtomicU8 = AtomicU8::new(UNCHOSEN);
const UNCHOSEN: u8 = u8::MAX;

/// Whether this build has the level. Each level adds a compiled copy of every search, so a build for one processor has
/// only the highest level of the processor and the portable level. The feature `all-levels` includes all levels.
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

    /// The levels that this machine and this build have, from the lowest to the highest.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|level| level.is_available()).collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn is_available(self) -> bool {
        // Detect all features that the functions `avx2` and `avx512` below enable.
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

    /// The level that structures use: the argument of [`choose`](Self::choose), by default the highest available level.
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

    /// Makes this the level of the whole process.
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
        // SAFETY: the machine has the instructions. `available` and `choose` accept a level only after `is_available`
        // has detected its instructions, and no other code makes a level, except `Portable` (see `Level`).
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 if WITH_AVX2 => unsafe { avx2(kernel) },
        // SAFETY: the machine has the instructions, as explained for `Avx2`.
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 if WITH_AVX512 => unsafe { avx512(kernel) },
        _ => kernel.run::<Portable<8>>(),
    }
}

// Not inlined, so each kernel has a separate stack frame.
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
