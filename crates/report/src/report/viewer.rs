//! The interactive view of the particles: its controls, its data and its program.

use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use super::Report;
use super::frames::{self, Field, Frames, Limits};
use crate::drawing::colours::ColourMap;

/// The program that draws the particles.
pub const SCRIPT: &str = concat!(
    include_str!("assets/viewer/data.js"),
    include_str!("assets/viewer/draw.js"),
    include_str!("assets/viewer/labels.js"),
    include_str!("assets/viewer/controls.js"),
);

/// What the program has to know besides the numbers, in words that it uses.
#[derive(Serialize)]
struct Data<'a> {
    dimension: usize,
    centre: &'a [f64],
    ids: &'a [u32],
    body: &'a [u32],
    bodies: Vec<&'a str>,
    /// Diameter of the particles of each body in m, 0 if it is unknown.
    diameters: Vec<f64>,
    fields: Vec<FieldData<'a>>,
    times: Vec<f64>,
    first: Option<&'a str>,
    title: &'a str,
    /// 256 colours each, as bytes red, green, blue.
    sequential: Vec<u8>,
    diverging: Vec<u8>,
}

#[derive(Serialize)]
struct FieldData<'a> {
    name: &'a str,
    unit: &'a str,
    components: &'a [String],
}

/// The view of the particles in the folder of the report.
pub fn section(report: &Report) -> Markup {
    let paths = report.folder.all_particles();
    let frames = frames::read(&paths, report.record.dimension, Limits::REPORT);
    html! {
        section #particles {
            h2 { "Particles" }
            @for fault in &frames.faults {
                p .notice { "Left out: " (fault) "." }
            }
            @if frames.frames.is_empty() {
                p { "There are no particle files to show." }
            } @else {
                (controls())
                p .remark { (extent(&frames)) }
                (data(report, &frames))
            }
        }
    }
}

/// How much of the run is shown, in numbers.
fn extent(frames: &Frames) -> String {
    let shown = frames.ids.len();
    let particles = match frames.stride {
        1 => format!("all {shown} particles"),
        stride => format!(
            "{shown} of {} particles (one of {stride}, drawn larger to fill their place)",
            frames.particles
        ),
    };
    let instants = match frames.frames.len() {
        count if count == frames.files => format!("all {count} instants"),
        count => format!("{count} of {} instants", frames.files),
    };
    format!(
        "Shown: {particles} at {instants}, numbers to 5 digits. The files in particles/ hold \
         everything."
    )
}

fn controls() -> Markup {
    html! {
        div #view .view hidden {
            div .bar {
                label { "Field " select #field {} }
                label { "Component " select #component {} }
                label { "Colours " select #range {
                    option value="all" { "range of all times" }
                    option value="most" { "inner 98 % of all times" }
                    option value="now" { "range of this time" }
                    option value="fixed" { "fixed" }
                } }
                label { "from " input #low type="number" step="any"; }
                label { "to " input #high type="number" step="any"; }
                label { "Map " select #map {
                    option value="auto" { "automatic" }
                    option value="sequential" { "sequential" }
                    option value="diverging" { "diverging" }
                } }
            }
            div .stage {
                canvas #drawing tabindex="0" aria-label="particles; drag to turn or move, scroll to zoom" {}
                canvas #overlay aria-hidden="true" {}
                div #tip .tip hidden {}
            }
            div .bar {
                button #play type="button" title="space" { "Play" }
                input #time type="range" min="0" step="1" aria-label="time";
                output #clock {}
            }
            div .bar {
                span #directions .buttons {
                    button type="button" data-view="iso" { "Oblique" }
                    button type="button" data-view="x" { "Along x" }
                    button type="button" data-view="y" { "Along y" }
                    button type="button" data-view="z" { "Along z" }
                }
                button #fit type="button" { "Fit" }
                label #sizing { "Size " input #size type="range" min="0.2" max="2" step="0.05" value="1"; }
                span #which .buttons {}
                button #save type="button" { "Save picture" }
                span #help .remark {}
            }
        }
        p #trouble .notice {
            "The interactive view needs a browser that runs scripts. The pictures below show the \
             same particles."
        }
    }
}

fn data(report: &Report, frames: &Frames) -> Markup {
    let field = |field: &'_ Field| -> (String, String, Vec<String>) {
        (field.name.clone(), field.unit.clone(), field.components.clone())
    };
    let fields: Vec<_> = frames.fields.iter().map(field).collect();
    let thinning = (frames.stride as f64).powf(1.0 / frames.dimension as f64);
    let diameters = report.record.bodies.iter().map(|body| {
        let usable = |spacing: &&f64| **spacing > 0.0 && spacing.is_finite();
        let spacings: Vec<f64> = body.spacing.iter().filter(usable).copied().collect();
        if spacings.is_empty() {
            return 0.0;
        }
        let logs: f64 = spacings.iter().map(|spacing| spacing.ln()).sum();
        thinning * (logs / spacings.len() as f64).exp()
    });
    let colours = |map: ColourMap| -> Vec<u8> {
        (0..256).flat_map(|place| map.colour(f64::from(place) / 255.0)).collect()
    };
    let data = Data {
        dimension: frames.dimension,
        centre: &frames.centre,
        ids: &frames.ids,
        body: &frames.bodies,
        bodies: report.record.bodies.iter().map(|body| body.name.as_str()).collect(),
        diameters: diameters.collect(),
        fields: fields
            .iter()
            .map(|(name, unit, components)| FieldData { name, unit, components })
            .collect(),
        times: frames.frames.iter().map(|frame| frame.time).collect(),
        first: report.first_field.as_deref(),
        title: &report.record.title,
        sequential: colours(ColourMap::Sequential),
        diverging: colours(ColourMap::Diverging),
    };
    // Serialising plain data into memory cannot fail; an empty view would be the outcome.
    let text = serde_json::to_string(&data).unwrap_or_default();
    html! {
        script #view-data type="application/json" { (PreEscaped(text.replace('<', "\\u003c"))) }
        @for frame in &frames.frames {
            script .frame type="text/plain" { (PreEscaped(&frame.data)) }
        }
        script type="module" { (PreEscaped(SCRIPT)) }
    }
}
