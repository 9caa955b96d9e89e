//! Points from outside in place of files.

use std::sync::Arc;

use super::super::*;
use crate::geometry::PointCloud;

fn text(file: &str) -> String {
    let case = template::new_case("a column");
    let shape = case.lines().find(|line| line.starts_with("shape = ")).unwrap();
    let points = format!("shape = {{ kind = \"points\", file = \"{file}\" }}");
    case.replace(shape, &points).replace("spacing = \"spacing\"\n", "")
}

fn options(dimension: usize) -> LoadOptions {
    let mut clouds = Clouds::default();
    let sites =
        (0..5).flat_map(|i| (0..9).map(move |j| [0.25 * f64::from(i), 0.25 * f64::from(j), 0.0]));
    let positions: Vec<f64> = sites.flat_map(|site| site.into_iter().take(dimension)).collect();
    let cloud = PointCloud::new(dimension, positions, vec![0.0625; 45]).unwrap();
    clouds.insert("sites", Arc::new(cloud));
    LoadOptions { clouds, ..LoadOptions::default() }
}

#[test]
fn a_body_is_made_of_them() {
    let case = parse(&text("@sites"), "case.toml", &options(2)).unwrap();
    assert!(case.files().is_empty(), "{:?}", case.files());
    let mut session = Session::new(&case).unwrap();
    assert_eq!(session.ids().len(), 45);
    assert_eq!(session.column("volume").unwrap().values, vec![0.0625; 45]);
    // What is left of a run has the name alone.
    assert!(case.as_run.contains("@sites") && recorded(&case.as_run, None).is_ok());
}

#[test]
fn those_that_do_not_fit_are_refused_with_their_place() {
    let refused = |file: &str, dimension| {
        let text = text(file);
        let problems = parse(&text, "case.toml", &options(dimension)).unwrap_err();
        let problem = problems.iter().next().unwrap();
        assert_eq!(&text[problem.place.unwrap().span()], format!("\"{file}\""));
        problem.message.clone()
    };
    assert_eq!(refused("@points", 2), "there is no cloud `@points`");
    assert_eq!(refused("@sites", 3), "the cloud `@sites` is in 3D and the case in 2D");
}
