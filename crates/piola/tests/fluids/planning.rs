//! What is told of a fluid before it runs.

use piola::case::{self, LoadOptions, Session};

/// Water in a tank, with walls of this many layers.
fn tank(layers: usize, top: &str, more: &str) -> String {
    format!(
        "version = 1\ntitle = 'A tank'\ndimension = 2\n[parameters]\ndx = 0.05\n\
         [[body]]\nname = 'water'\nshape = {{ kind = 'box', min = [0.0, 0.0], max = [1.0, 0.5] }}\n\
         spacing = 'dx'\nlattice = {{ on = 'cells' }}\n\
         material = {{ kind = 'weakly_compressible', density = 1000.0, wave_speed = 20.0 }}\n\
         [[body]]\nname = 'tank'\nshape = {{ kind = 'difference', \
         from = {{ kind = 'box', min = ['-{layers}*dx', '-{layers}*dx'], max = ['1+{layers}*dx', {top}] }}, \
         remove = [{{ kind = 'box', min = [0.0, 0.0], max = [1.0, 0.5] }}] }}\n\
         spacing = 'dx'\nlattice = {{ on = 'cells' }}\n\
         material = {{ kind = 'weakly_compressible', density = 1000.0, wave_speed = 20.0 }}\n\
         wall = {{ slip = 'free' }}\n\
         [scheme]\nkind = 'transport_velocity'\n{more}\n[time]\nend = 0.1\n"
    )
}

fn session(text: &str) -> Result<Session, String> {
    let case = case::parse(text, "case.toml", &LoadOptions::default());
    case.and_then(|case| Session::new(&case)).map_err(|problems| problems.to_string())
}

#[test]
fn a_fluid_that_borders_on_empty_space_is_told() {
    let told = |text: &str| {
        let warnings = session(text).unwrap().plan().warnings;
        warnings.iter().any(|warning| warning.contains("border on empty space"))
    };
    assert!(told(&tank(4, "'0.5 - 0.5 * dx'", "")), "no lid");
    assert!(!told(&tank(4, "'0.5 - 0.5 * dx'", "free_surface = true")), "a free surface");
    assert!(!told(&tank(4, "'0.5 + 4*dx'", "")), "a lid");
}

/// Of a width of 19.5 spacings a lattice makes 20, of 17.4 it makes 17, of a height of 2.45 two: 2.5, 2.4 and 22 % off.
#[test]
fn lattices_that_fit_their_shapes_may_differ_a_little() {
    let narrow = |width: &str, height: &str| {
        let text = tank(4, "'0.5 + 4*dx'", "")
            .replace("max = [1.0, 0.5] }\n", &format!("max = ['{width}', '{height}'] }}\n"));
        session(&text)
    };
    for width in ["19.5 * dx", "17.4 * dx"] {
        assert!(narrow(width, "10 * dx").is_ok(), "{width}");
    }
    let error = narrow("20 * dx", "2.45 * dx").err().expect("spacings that are too far apart");
    assert!(error.contains("share one spacing"), "{error}");
}
