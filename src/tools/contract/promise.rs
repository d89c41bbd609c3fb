//! What plugins promise, and how to keep it.

use std::fmt;

/// What a plugin promises. Those that come first are the gravest: where they are broken, others break too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Promise {
    /// A constructor makes something of values that its table allows.
    TakesWhatItsTableAllows,
    /// A scene's dump is a scene.
    DumpLoadsAgain,
    /// A distance is one of the span, or a miss.
    DistanceIsInItsSpan,
    /// Shapes do not change.
    DistanceIsTheSameAgain,
    /// Single rays and packets agree.
    PacketsAgree,
    /// A normal is a unit vector.
    NormalIsUnit,
    /// A hit is on the surface, from wherever it is looked for.
    HitIsOnTheSurface,
    /// What is certain about a first hit is so.
    AgreesWithItsProof,
    /// Bounds hold all of a shape.
    BoundsHoldHits,
    /// A normal stands upright on the surface.
    NormalIsUpright,
    /// The normals of one side of a surface point to one side.
    NormalsAgree,
    /// The normals of a convex shape point out of it.
    NormalsPointOut,
    /// A shape does not meet its own rays on a side where it says so.
    IsNotMetAgain,
    /// A ray does not meet the surface where it leaves it.
    StartIsNoHit,
    /// A shape knows what lies on it.
    HitIsTouched,
    /// There is something to see.
    IsMet,
    /// Reflectivities are finite and not below 0.
    ReflectivityIsSound,
    /// Light is finite.
    LightIsFinite,
    /// A camera looks along unit vectors.
    CameraLooks,
    /// A profile is finite, and somewhere above 0.
    ProfileIsFinite,
}

impl Promise {
    /// All of them, the gravest first.
    pub const ALL: [Self; 20] = [
        Self::TakesWhatItsTableAllows,
        Self::DumpLoadsAgain,
        Self::DistanceIsInItsSpan,
        Self::DistanceIsTheSameAgain,
        Self::PacketsAgree,
        Self::NormalIsUnit,
        Self::HitIsOnTheSurface,
        Self::AgreesWithItsProof,
        Self::BoundsHoldHits,
        Self::NormalIsUpright,
        Self::NormalsAgree,
        Self::NormalsPointOut,
        Self::IsNotMetAgain,
        Self::StartIsNoHit,
        Self::HitIsTouched,
        Self::IsMet,
        Self::ReflectivityIsSound,
        Self::LightIsFinite,
        Self::CameraLooks,
        Self::ProfileIsFinite,
    ];

    /// How to keep it.
    pub fn cure(self) -> &'static str {
        match self {
            Self::TakesWhatItsTableAllows => {
                "say with `must` what each attribute's values must be; refuse only what no single attribute shows"
            }
            Self::DumpLoadsAgain => {
                "give a default that keeps its own rule, and rules that depend on values alone"
            }
            Self::DistanceIsInItsSpan => {
                "end `distance` with `within.keep(...)`: what is outside of the span or NaN becomes `MISS`"
            }
            Self::DistanceIsTheSameAgain => "let `distance` depend on the shape, the ray and the span alone",
            Self::PacketsAgree => {
                "`bracket` holds `distance`, and `refine` is it to the last bit or NaN; leave out `Bracketed`, or `even`, if in doubt"
            }
            Self::NormalIsUnit => "end `normal` with `.normalize()`, and say what it is where there is none",
            Self::HitIsOnTheSurface => {
                "let `distance` give the first hit of the same surface for every ray, from both of its sides and from inside"
            }
            Self::AgreesWithItsProof => {
                "let `distance` and the shape's `Equation` describe one surface, with the same part kept"
            }
            Self::BoundsHoldHits => "make `bounds` hold every point of the shape; give none if in doubt",
            Self::HitIsTouched => {
                "let `touches` hold within the error that it is given at least, and `bracket` be without a certain end there; leave out `touches`, and `Bracketed`, if in doubt"
            }
            Self::NormalIsUpright => {
                "let `normal` be the gradient of the surface's formula, made a unit vector"
            }
            Self::NormalsAgree => {
                "let `normal` depend on the point alone, without a jump on a smooth surface"
            }
            Self::NormalsPointOut => "turn `normal` around: it points out of a closed shape",
            Self::IsNotMetAgain => "answer `meets_itself` with `true` for that side, which is the default",
            Self::StartIsNoHit => {
                "where `within.leaves` is given, leave the root out at which the ray starts, however rounding has it"
            }
            Self::IsMet => "let `distance` give the distance of the first hit, and not `MISS` for all",
            Self::ReflectivityIsSound => {
                "look for a division by 0 or a root of a negative number, and clamp what may fall below 0"
            }
            Self::LightIsFinite => "answer `None` where no light goes, the light's own place included",
            Self::CameraLooks => "state rules for the attributes that the camera is made from",
            Self::ProfileIsFinite => {
                "give a formula that is finite at each height from 0 to 4 and above 0 at some"
            }
        }
    }

    pub(super) fn fault(self, found: impl Into<String>) -> Fault {
        Fault { promise: self, found: found.into() }
    }
}

impl fmt::Display for Promise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TakesWhatItsTableAllows => "the constructor takes values that the table allows",
            Self::DumpLoadsAgain => "a dumped scene loads again, to the same dump",
            Self::DistanceIsInItsSpan => "a distance lies inside of the span, or is `MISS`",
            Self::DistanceIsTheSameAgain => "the same ray has the same distance again",
            Self::PacketsAgree => "what packets are told is what single rays are told",
            Self::NormalIsUnit => "a normal is a unit vector",
            Self::HitIsOnTheSurface => "a hit is one wherever its ray starts",
            Self::AgreesWithItsProof => "the distance is where `certify` proves the first hit",
            Self::BoundsHoldHits => "the bounds hold every hit",
            Self::HitIsTouched => "a shape touches the points where it is hit",
            Self::NormalIsUpright => "a normal stands upright on the surface",
            Self::NormalsAgree => "normals close together point to the same side",
            Self::NormalsPointOut => "the normals of a convex shape point out of it",
            Self::IsNotMetAgain => "a shape that does not meet itself meets no ray that leaves it",
            Self::StartIsNoHit => "a ray that leaves the surface meets what lies beyond, and not its start",
            Self::IsMet => "rays meet the shape",
            Self::ReflectivityIsSound => {
                "a reflectivity is finite, and not below 0 where the material's is not"
            }
            Self::LightIsFinite => "a light's place, size and light are finite",
            Self::CameraLooks => "a camera has pixels, samples and rays along unit vectors",
            Self::ProfileIsFinite => "a profile is finite from 0 to 4, and somewhere above 0",
        })
    }
}

/// A promise that is not kept, and what was found instead.
#[derive(Debug)]
pub(super) struct Fault {
    pub promise: Promise,
    pub found: String,
}
