//! Which of a processor's instructions are used: loops over packets of rays are compiled for each level, and the best
//! one that is there is chosen at run time.
//!
//! The same operations in the same order give the same bits on every level: Rust neither reorders nor fuses them.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::fmt;

/// A level of instructions that this machine has. There is no way to make one that it has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cpu(Level);

/// Sets of instructions, each with those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Level {
    /// What every machine has: SSE2 on x86-64.
    Baseline,
    /// AVX2: four numbers at a time.
    Avx2,
    /// AVX-512: eight numbers at a time.
    Avx512,
}

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
    /// The levels that this machine has, the best one last.
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        Level::value_variants().iter().filter(|level| level.is_here()).copied().map(Self)
    }

    /// This level, where the machine has it.
    pub fn of(level: Level) -> Option<Self> {
        level.is_here().then_some(Self(level))
    }

    /// The best level that this machine has.
    pub fn best() -> Self {
        Self::all().next_back().unwrap_or(Self(Level::Baseline))
    }

    /// What it is.
    #[inline(always)]
    pub fn level(self) -> Level {
        self.0
    }
}

impl fmt::Display for Cpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.0.to_possible_value().as_ref().map_or("", PossibleValue::get_name))
    }
}

/// Defines functions that are compiled for every level; each takes the [`Cpu`] to use as its first argument.
///
/// What such a function calls takes part in that where it is inlined. Vectors to be written are named behind `=>` and
/// are its last arguments. Inside, their arrays are arguments of their own, by which the compiler knows that none is
/// part of another: else it looks at that at every call, and takes rays one by one where there are few.
macro_rules! kernels {
    ($(
        $(#[$attribute:meta])*
        $visible:vis fn $name:ident$([$T:ident: $Bound:path])?$(<const $N:ident>)?($($argument:ident: $type:ty),* $(,)?)
            $(=> $out:ident $(, $second:ident)?)? $(-> $result:ty)? $body:block
    )*) => {$(
        $(#[$attribute])*
        #[allow(clippy::too_many_arguments, reason = "they are arrays")]
        $visible fn $name$(<$T: $Bound>)?$(<const $N: usize>)?(
            cpu: $crate::simd::cpu::Cpu, $($argument: $type,)*
            $($out: $crate::simd::soa::ViewMut, $($second: $crate::simd::soa::ViewMut)?)?
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
                        )?
                    )?
                ) ($(-> $result)?)
                {
                    $(
                        let mut $out = $crate::simd::soa::ViewMut { x, y, z };
                        $(let mut $second = $crate::simd::soa::ViewMut { x: u, y: v, z: w };)?
                    )?
                    $body
                }
                {
                    body($($argument,)* $($crate::simd::cpu::beside!($out, x), y, z, $($crate::simd::cpu::beside!($second, u), v, w)?)?)
                }
            }
            match cpu.level() {
                // SAFETY: there is no `Cpu` of a level that the machine has not.
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code)]
                $crate::simd::cpu::Level::Avx512 => unsafe { avx512($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z)?)?) },
                #[cfg(target_arch = "x86_64")]
                #[allow(unsafe_code)]
                $crate::simd::cpu::Level::Avx2 => unsafe { avx2($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z)?)?) },
                _ => body($($argument,)* $($out.x, $out.y, $out.z, $($second.x, $second.y, $second.z)?)?),
            }
        }
    )*};
}

/// A kernel's body, and the functions that it becomes part of for each level.
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

/// Something that is there where a kernel has vectors to be written.
macro_rules! beside {
    ($out:ident, $($what:tt)*) => { $($what)* };
}

pub(crate) use {beside, kernels, levels};
