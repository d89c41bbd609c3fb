//! Profiles of all kinds: what loads, what is refused, and that no part is lost or invented.

use super::*;
use std::time::Instant;

fn surface(profile: &str, height: f64) -> Result<Revolution, NoSurface> {
    Revolution::new(&Formula::parse(profile).expect("a formula"), height, Finish::Root)
}

#[test]
fn t() {
    for (p, h) in [
        ("sin(y)", 1e9),
        (
            "1e-8 + ln(sin(2) ^ 2) + sin(tan(pi ^ y) / 0.5) + min(abs(0.5 - 1e-8), pi ^ 2.11 * 0.5) ^ abs(max(pi, y)) * 1e-9 * 1e-8 * floor(0.5 - (y) * cos(7.27))",
            12.0,
        ),
        ("min(2, 1/abs(y-3))", 6.0),
        ("max(0.2, ln(y))", 6.0),
        ("y^y/10", 3.0),
        ("max(0.3 - y, 2 - 1e14*(y-3.1)^2)", 6.0),
        ("max(0.3, 2 - 1e14*(y-3.1)^2)", 6.0),
        ("2 + sin(y)", 6.28),
        ("2+sin(y)", 1e9),
        ("2e6+1e6*sin(y/1e6)", 6e6),
        ("y^2-6*y+9", 6.0),
        ("y^2-6*y+9.1", 6.0),
        ("sqrt(9-y^2)", 3.0),
        ("0.5 + 0.25*floor(y)", 6.28),
        ("0.6 + 0.5*abs(y-3)", 6.28),
        ("cos(sin(y) + 1e-8 - exp(y))", 7.88),
        ("sin(1/y)", 6.0),
        ("1/(y-3)", 6.0),
        ("ln(y-3)", 6.0),
        ("tan(y)", 6.0),
        ("abs(y-3)-(y-3)", 6.0),
        ("0.5*y^2", 6.0),
        ("1e9*sqrt(1-(y/1e9)^2)", 1e9),
        ("1e28*y^2-6e28*y+9e28-1e11", 6.0),
        ("1 + sin(100*y)", 6.0),
        ("sin(100*y)", 6.0),
        ("floor(y)-2.5", 6.0),
        ("exp(-1/y)", 6.0),
        ("max(0,sin(y))", 1e5),
        ("sin(y)", 1e4),
    ] {
        let start = Instant::now();
        let s = surface(p, h);
        let t = start.elapsed();
        println!(
            "{p} {h}: {t:?} {}",
            match s {
                Ok(s) => format!("{s} widest {}", s.slabs.widest()),
                Err(e) => e.told().0,
            }
        );
    }
}
