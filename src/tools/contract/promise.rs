//! The promises of plugins, and how to keep them.

use std::fmt;

/// A promise of a plugin. The gravest come first: where one of them is broken, later ones break too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Promise {
    /// The constructor accepts all values that its table allows.
    TakesWhatItsTableAllows,
    /// A scene's dump is a scene.
    DumpLoadsAgain,
    /// A distance lies within the range of the ray, or is a miss.
    DistanceIsInItsSpan,
    /// A distance is the same when it is computed again.
    DistanceIsTheSameAgain,
    /// Single rays and packets agree.
    PacketsAgree,
    /// A normal is a unit vector.
    NormalIsUnit,
    /// A hit is on the surface, for rays from any side.
    HitIsOnTheSurface,
    /// The first hit agrees with the proof.
    AgreesWithItsProof,
    /// The bounds contain the whole shape.
    BoundsHoldHits,
    /// A hit from far away is where one from near is.
    HitIsAccurate,
    /// A normal is perpendicular to the surface.
    NormalIsUpright,
    /// Normals of neighbouring points point to the same side of the surface.
    NormalsAgree,
    /// The normals of a convex shape point out of it.
    NormalsPointOut,
    /// A ray that leaves a shape does not hit it again on a side where the shape says so.
    IsNotMetAgain,
    /// A ray does not hit the surface at its own origin.
    StartIsNoHit,
    /// A shape recognises points that lie on it.
    HitIsTouched,
    /// The coordinates u and v are from 0 to 1.
    UvIsWithin,
    /// Some ray hits the shape.
    IsMet,
    /// A ray's hit is found within a limited time.
    RayIsQuick,
    /// Reflectivities are finite and not below 0.
    ReflectivityIsSound,
    /// A material's interface reflects a fraction, and transmits the rest to the other side or absorbs it.
    LightGoesOn,
    /// A light's location, size and emission are finite.
    LightIsFinite,
    /// A background's colours are finite, not below 0, and within their bounds.
    BackgroundIsSound,
    /// A camera's directions are unit vectors, the same each time and in packets.
    CameraLooks,
    /// A camera's statements about its rays are true.
    CameraKnows,
    /// A profile's radius is finite, and somewhere above 0.
    ProfileIsFinite,
}

impl Promise {
    /// All promises, the gravest first.
    pub const ALL: [Self; 26] = [
        Self::TakesWhatItsTableAllows,
        Self::DumpLoadsAgain,
        Self::DistanceIsInItsSpan,
        Self::DistanceIsTheSameAgain,
        Self::PacketsAgree,
        Self::NormalIsUnit,
        Self::HitIsOnTheSurface,
        Self::AgreesWithItsProof,
        Self::BoundsHoldHits,
        Self::HitIsAccurate,
        Self::NormalIsUpright,
        Self::NormalsAgree,
        Self::NormalsPointOut,
        Self::IsNotMetAgain,
        Self::StartIsNoHit,
        Self::HitIsTouched,
        Self::UvIsWithin,
        Self::IsMet,
        Self::RayIsQuick,
        Self::ReflectivityIsSound,
        Self::LightGoesOn,
        Self::LightIsFinite,
        Self::BackgroundIsSound,
        Self::CameraLooks,
        Self::CameraKnows,
        Self::ProfileIsFinite,
    ];

    /// Returns how to keep the promise.
    pub fn help(self) -> &'static str {
        match self {
            Self::TakesWhatItsTableAllows => {
                "state the rule of each attribute with `must`; in the constructor, refuse only what depends on several attributes"
            }
            Self::DumpLoadsAgain => {
                "give a default that satisfies its own rule, and rules that depend on the values alone"
            }
            Self::DistanceIsInItsSpan => {
                "end `distance` with `range.keep(...)`: a distance outside the ray range, or NaN, becomes `MISS`"
            }
            Self::DistanceIsTheSameAgain => {
                "make `distance` depend on the shape, the ray and the ray range alone"
            }
            Self::PacketsAgree => {
                "make `t_bounds` contain the `distance` of each ray that its ray stands for, and `refine` equal it to the last bit or be NaN; if in doubt, leave out `Bracketed`, or `uniform`; where there is a `shading_normal`, `is_smooth` is true"
            }
            Self::NormalIsUnit => {
                "end `normal` with `.normalize()`, and choose a normal where the surface has none"
            }
            Self::HitIsOnTheSurface => {
                "make `distance` return the first hit of the same surface for every ray, from both sides and from inside"
            }
            Self::AgreesWithItsProof => {
                "make `distance` and the shape's `Equation` describe the same surface, clipped in the same way"
            }
            Self::BoundsHoldHits => "make `bounds` contain every point of the shape; return none if in doubt",
            Self::HitIsAccurate => {
                "compute `distance` from the ray's closest approach to the shape: differences of large squares lose all digits"
            }
            Self::UvIsWithin => {
                "scale u and v to 0 to 1, also at seams and poles; `uv` is `None` for a shape that has none"
            }
            Self::RayIsQuick => "bound the number of steps in `distance`",
            Self::HitIsTouched => {
                "make `is_on_surface` true within at least the error that it is given, and `t_bounds` without a certain end there; if in doubt, leave out `is_on_surface`, and `Bracketed`"
            }
            Self::NormalIsUpright => "make `normal` the gradient of the surface's formula, normalized",
            Self::NormalsAgree => {
                "make `normal` depend on the point alone, and continuous on a smooth surface"
            }
            Self::NormalsPointOut => "negate `normal`: it must point out of a closed shape",
            Self::IsNotMetAgain => {
                "let `can_hit_itself` have that side: `Sides::BOTH`, the default, is always correct"
            }
            Self::StartIsNoHit => {
                "where `range.origin_side` is given, leave out the root at which the ray starts, whatever rounding makes of it"
            }
            Self::IsMet => "make `distance` return the distance of the first hit, not `MISS` for every ray",
            Self::ReflectivityIsSound => {
                "look for a division by 0 or a root of a negative number, and clamp what may become negative"
            }
            Self::LightGoesOn => {
                "clamp the reflected fraction, and normalize the direction in which the rest is transmitted"
            }
            Self::LightIsFinite => "return 0 where no light arrives, including at the light's own location",
            Self::BackgroundIsSound => {
                "state rules for the attributes; `brightest` bounds all colours, and a `colour` of intervals those in a box"
            }
            Self::CameraLooks => "state rules for the attributes from which the camera is made",
            Self::CameraKnows => {
                "make `origins`, `project`, `corners`, `sight` and `line` agree with `ray`; if in doubt, leave them out, all but `origins`"
            }
            Self::ProfileIsFinite => {
                "give a formula that is finite at every height from 0 to 4 and above 0 at some of them"
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
            Self::TakesWhatItsTableAllows => "the constructor accepts all values that the table allows",
            Self::DumpLoadsAgain => "a dumped scene loads again, and its dump is the same",
            Self::DistanceIsInItsSpan => "a distance lies within the ray range, or is `MISS`",
            Self::DistanceIsTheSameAgain => "the same ray always has the same distance",
            Self::PacketsAgree => "packets of rays get the same answers as single rays",
            Self::NormalIsUnit => "a normal is a unit vector",
            Self::HitIsOnTheSurface => "a hit is found wherever its ray starts",
            Self::AgreesWithItsProof => "the distance is that of the first hit that `certify` proves",
            Self::BoundsHoldHits => "the bounds contain every hit",
            Self::HitIsTouched => "`is_on_surface` is true at each point where a ray hits the shape",
            Self::HitIsAccurate => "a hit from far away is where one from near is",
            Self::UvIsWithin => "the coordinates u and v are from 0 to 1",
            Self::RayIsQuick => "`distance` takes at most as long as a million sines",
            Self::NormalIsUpright => "a normal is perpendicular to the surface",
            Self::NormalsAgree => "neighbouring normals point to the same side",
            Self::NormalsPointOut => "the normals of a convex shape point outward",
            Self::IsNotMetAgain => "a ray that leaves a shape does not hit it again on a side that `can_hit_itself` leaves out",
            Self::StartIsNoHit => "a ray that leaves the surface hits what lies beyond, not its own start",
            Self::IsMet => "some ray hits the shape",
            Self::ReflectivityIsSound => {
                "a reflectivity is finite, and not negative unless the material's is"
            }
            Self::LightGoesOn => {
                "an interface reflects a fraction from 0 to 1, and transmits the rest to the other side or absorbs it"
            }
            Self::LightIsFinite => "a light's location, size and emission are finite",
            Self::BackgroundIsSound => {
                "a background's colours are finite, not negative, and within `brightest` and their bounds in intervals"
            }
            Self::CameraLooks => "a camera has pixels, samples and rays with unit directions",
            Self::CameraKnows => "what a camera says about its rays is true",
            Self::ProfileIsFinite => "a profile is finite from 0 to 4, and above 0 somewhere",
        })
    }
}

/// A promise that is broken, and what was found instead.
#[derive(Debug)]
pub(super) struct Fault {
    pub promise: Promise,
    pub found: String,
}
