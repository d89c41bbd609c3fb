//! Instruction sets: kernels, the loops over packets of rays, are compiled for each level of instructions, and the best
//! level that the processor has is chosen at run time.
//!
//! The same operations in the same order give the same bits on every level: Rust neither reorders nor fuses them.

use crate::named;
use crate::text::Named;
use std::fmt;

/// A level of instructions that this machine has. A `Cpu` cannot be made for a level that the machine lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cpu(Level);

/// Levels of instructions; each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// What every machine has: SSE2 on x86-64 and NEON on aarch64, two numbers at a time.
    Baseline,
    /// AVX2: four numbers at a time.
    Avx2,
    /// AVX-512: eight numbers at a time.
    Avx512,
}

named!(Level { Baseline => "baseline", Avx2 => "avx2", Avx512 => "avx512" });

impl Level {
    #[cfg(target_arch = "x86_64")]
    fn is_here(self) -> bool {
        match self {
            Self::Baseline => true,
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512bw")
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn is_here(self) -> bool {
        self == Self::Baseline
    }
}

impl Cpu {
    /// Returns the levels that this machine has, from the lowest to the highest.
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        Level::ALL.iter().filter(|level| level.is_here()).copied().map(Self)
    }

    /// Returns this level, or `None` if the machine lacks it.
    pub fn of(level: Level) -> Option<Self> {
        level.is_here().then_some(Self(level))
    }

    /// Returns the highest level that this machine has.
    pub fn best() -> Self {
        Self::all().next_back().unwrap_or(Self(Level::Baseline))
    }

    /// Returns the level.
    #[inline(always)]
    pub fn level(self) -> Level {
        self.0
    }
}

impl fmt::Display for Cpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.0.name())
    }
}

/// Defines kernels: functions that are compiled for every level of instructions. Each takes the [`Cpu`] to use as its
/// first argument.
///
/// ```text
/// kernels! {
///     fn refine[T: ScalarIntersect](shape: &T, out: &mut [f64]) { ... }
/// }
/// ```
///
/// expands to
///
/// ```text
/// fn refine<T: ScalarIntersect>(cpu: Cpu, shape: &T, out: &mut [f64]) {
///     #[inline(always)]
///     fn body<T: ScalarIntersect>(shape: &T, out: &mut [f64]) { ... }
///     #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
///     fn avx512<T: ScalarIntersect>(shape: &T, out: &mut [f64]) { body(shape, out) }
///     #[target_feature(enable = "avx2")]
///     fn avx2<T: ScalarIntersect>(shape: &T, out: &mut [f64]) { body(shape, out) }
///     match cpu.level() {
///         Level::Avx512 => unsafe { avx512(shape, out) },
///         Level::Avx2 => unsafe { avx2(shape, out) },
///         _ => body(shape, out),
///     }
/// }
/// ```
///
/// A function that a kernel calls is compiled for the level only where it is inlined; elsewhere, rays are taken one
/// by one. In the release profile, most functions of the standard library that take a closure or an iterator, such as
/// `map` of an array or `zip`, are not inlined; `docs/calls.sh` lists what kernels call. Vectors to be written are
/// named after `=>` and are the kernel's last arguments. In the body, their arrays are separate arguments, which
/// tells the compiler that they do not overlap: otherwise it checks for overlap at every call, and takes small counts
/// of rays one by one.
#[macro_export]
macro_rules! kernels {
    ($(
        $(#[$attribute:meta])*
        $visible:vis fn $name:ident$([$T:ident: $Bound:path])?$(<const $N:ident>)?($($argument:ident: $type:ty),* $(,)?)
            $(=> $out:ident $(, $second:ident $(, $third:ident)?)?)? $(-> $result:ty)? $body:block
    )*) => {$(
        $(#[$attribute])*
        #[allow(clippy::too_many_arguments, reason = "they are arrays")]
        $visible fn $name$(<$T: $Bound>)?$(<const $N: usize>)?(
            cpu: $crate::simd::cpu::Cpu, $($argument: $type,)*
            $(
                $out: $crate::simd::soa::ViewMut,
                $($second: $crate::simd::soa::ViewMut, $($third: $crate::simd::soa::ViewMut)?)?
            )?
        ) $(-> $result)? {
            $crate::simd::cpu::levels! {
                ($(<$T: $Bound>)?$(<const $N: usize>)?) (
                    $($argument: $type,)*
                    $(
                        x: $crate::simd::cpu::beside!($out, &mut [f64]),
                        y: $crate::simd::cpu::beside!($out, &mut [f64]),
                        z: $crate::simd::cpu::beside!($out, &mut [f64]),
                        $(
                            u: $crate::simd::cpu::beside!($second, &mut [f64]),
                            v: $crate::simd::cpu::beside!($second, &mut [f64]),
                            w: $crate::simd::cpu::beside!($second, &mut [f64]),
                            $(
                                p: $crate::simd::cpu::beside!($third, &mut [f64]),
                                q: $crate::simd::cpu::beside!($third, &mut [f64]),
                                r: $crate::simd::cpu::beside!($third, &mut [f64]),
                            )?
                        )?
                    )?
                ) ($(-> $result)?)
                {
                    $(
                        let mut $out = $crate::simd::soa::ViewMut { x, y, z };
                        $(
                            let mut $second = $crate::simd::soa::ViewMut { x: u, y: v, z: w };
                            $(let mut $third = $crate::simd::soa::ViewMut { x: p, y: q, z: r };)?
                        )?
                    )?
                    $body
                }
                {
                    body(
                        $($argument,)*
                        $(
                            $crate::simd::cpu::beside!($out, x), y, z,
                            $(
                                $crate::simd::cpu::beside!($second, u), v, w,
                                $($crate::simd::cpu::beside!($third, p), q, r)?
                            )?
                        )?
                    )
                }
            }
            match cpu.level() {
                // SAFETY: a `Cpu` exists only for levels that the machine has.
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code)]
                $crate::simd::cpu::Level::Avx512 => unsafe { avx512($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z, $($third.x, $third.y, $third.z)?)?)?) },
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code)]
                $crate::simd::cpu::Level::Avx2 => unsafe { avx2($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z, $($third.x, $third.y, $third.z)?)?)?) },
                _ => body($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z, $($third.x, $third.y, $third.z)?)?)?),
            }
        }
    )*};
}

/// Defines a kernel's body and, for each level, the function that the body is inlined into.
#[macro_export]
macro_rules! levels {
    (($($generics:tt)*) ($($arguments:tt)*) ($($result:tt)*) $body:block $call:block) => {
        #[inline(always)]
        #[allow(clippy::too_many_arguments, reason = "they are arrays")]
        fn body$($generics)*($($arguments)*) $($result)* $body

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
        #[allow(clippy::too_many_arguments, reason = "they are arrays")]
        fn avx512$($generics)*($($arguments)*) $($result)* $call

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        #[allow(clippy::too_many_arguments, reason = "they are arrays")]
        fn avx2$($generics)*($($arguments)*) $($result)* $call
    };
}

/// Expands to its second argument; repeats it for each vector that a kernel writes.
#[macro_export]
macro_rules! beside {
    ($out:ident, $($what:tt)*) => { $($what)* };
}

pub use {beside, kernels, levels};
