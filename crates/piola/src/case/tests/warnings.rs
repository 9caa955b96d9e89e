//! What `piola check` warns of before a run.

use super::read_with;
use crate::case::{Plan, Session};

fn planned(text: &str, set: &[&str]) -> Plan {
    let case = read_with(text, set).unwrap_or_else(|problems| panic!("{problems}"));
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    session.plan()
}

fn warns(plan: &Plan, of: &str) -> bool {
    plan.warnings.iter().any(|text| text.contains(of))
}

/// At 4.5 sqrt(2 g H) the weight of 0.95 m of water, above half a spacing of 0.1 m, compresses it by
/// exp(0.95 / (2 * 4.5^2)) - 1 = 2.4 %, at ten times by 0.5 %.
#[test]
fn a_wave_speed_that_lets_water_sag_is_warned_of() {
    let water = include_str!("../../../../../cases/ctvf/still-water/case.toml");
    let coarse = "parameters.dx=0.1";
    assert!(!warns(&planned(water, &[coarse]), "compresses the fluid"));
    let slow = planned(water, &[coarse, "parameters.wave_speed='4.5 * sqrt(2 * g * height)'"]);
    assert!(warns(&slow, "compresses the fluid by 2.4 %"), "{:?}", slow.warnings);
}

/// The growth of undamped modes with Heun's method: over two hundred seconds it is more than any energy there is.
#[test]
fn steps_that_feed_undamped_modes_are_warned_of() {
    let piston = include_str!("../../../../../cases/upwind/piston/case.toml");
    let set = ["time.end=200", "time.integrator='tvd_rk2'"];
    let plan = planned(piston, &set);
    let undamped = plan.undamped.expect("nothing damps it");
    // Each period of the fastest mode: its phase advances by w dt = cfl-like in a step, of which z^4 / 4 is gained.
    let phase = std::f64::consts::TAU * plan.step / undamped.period;
    let gain = 1.0 + phase.powi(4) / 4.0;
    let by_period = gain.powf(undamped.period / plan.step);
    assert!((undamped.by_period / by_period - 1.0).abs() < 1e-9, "{undamped:?}, {by_period}");
    assert!(warns(&plan, "`tvd_rk2` multiplies its energy by"), "{:?}", plan.warnings);
    // It is nothing over a hundredth of that, and nothing for what keeps it.
    assert!(!warns(&planned(piston, &["time.end=0.02", set[1]]), "multiplies its energy"));
    let kept = planned(piston, &[set[0], "time.integrator='kick_drift_kick'"]);
    assert!(!warns(&kept, "multiplies its energy"), "{:?}", kept.warnings);
}

#[test]
fn the_printed_dissipation_is_warned_of_and_is_for_one_density() {
    let column = include_str!("../../../../../cases/upwind/column-impact/case.toml");
    let set = |kind: &str| format!("scheme.dissipation='{kind}'");
    for (kind, says) in [
        ("as_printed", "(3.38) as printed lacks the density and (3.42) has the wrong sign"),
        ("printed_3_38", "(3.38) as printed lacks the density, so that"),
        ("printed_3_42", "(3.42) as printed has the wrong sign, so that"),
    ] {
        let plan = planned(column, &[&set(kind)]);
        assert!(warns(&plan, says), "{kind}: {:?}", plan.warnings);
    }
    assert!(!warns(&planned(column, &[&set("corrected")]), "as printed"));
    let body = &column[column.find("[[body]]").unwrap()..column.find("[scheme]").unwrap()];
    let second = body.replace("name = \"column\"", "name = \"other\"");
    let two = column.replacen("[scheme]", &format!("{second}[scheme]"), 1);
    let far = "body.other.shape={ kind = 'box', min = [10.0, 0.0], max = [12.0, 2.0] }";
    let case = read_with(&two, &[far, "body.other.material.density=500.0", &set("as_printed")]);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let told = Session::new(&case).err().expect("there are two densities").to_string();
    assert!(
        told.contains("the printed (3.38) is available only for bodies of one density"),
        "{told}"
    );
}
