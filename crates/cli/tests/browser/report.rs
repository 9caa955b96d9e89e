//! What a reader of the report sees and does.

use std::path::Path;

use crate::browser::Browser;
use crate::results::Results;

/// What is drawn of the particles: pixels that are not background, a number for where they are,
/// one for their colours, and how many colours there are.
#[derive(Debug, PartialEq)]
struct Drawn {
    pixels: u64,
    shape: u64,
    colours: u64,
    tones: u64,
}

fn drawn(browser: &mut Browser, canvas: &str) -> Drawn {
    let found = browser.evaluate(&format!(
        "(() => {{
            const from = document.getElementById('{canvas}');
            const copy = document.createElement('canvas');
            [copy.width, copy.height] = [from.width, from.height];
            const pen = copy.getContext('2d');
            pen.drawImage(from, 0, 0);
            const bytes = pen.getImageData(0, 0, copy.width, copy.height).data;
            let pixels = 0, shape = 0, colours = 0;
            const tones = new Set();
            for (let i = 0; i < bytes.length; i += 4) {{
                if (!bytes[i + 3]) continue;
                const colour = bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2];
                pixels += 1;
                shape = (shape * 31 + i) % 4294967291;
                colours = (colours * 31 + colour) % 4294967291;
                tones.add(colour);
            }}
            return [pixels, shape, colours, tones.size];
        }})()"
    ));
    let [pixels, shape, colours, tones] = [0, 1, 2, 3].map(|i| found[i].as_f64().unwrap() as u64);
    Drawn { pixels, shape, colours, tones }
}

/// Opens a report and waits until its particles are drawn.
fn opened(browser: &mut Browser, page: &Path) {
    browser.open(page);
    browser.wait_for("document.getElementById('view').dataset.ready === 'yes'");
    settled(browser);
}

/// Waits until everything asked for is drawn: two frames of the screen.
fn settled(browser: &mut Browser) {
    browser.evaluate(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))",
    );
}

/// Chooses a field by its name.
fn choose(browser: &mut Browser, field: &str) {
    let chosen = browser.evaluate(&format!(
        "(() => {{ const e = document.getElementById('field');
            e.value = [...e.options].find((o) => o.textContent === '{field}')?.value;
            e.dispatchEvent(new Event('change')); return e.selectedIndex >= 0; }})()"
    ));
    assert_eq!(chosen, true, "there is no field {field}");
    settled(browser);
}

/// Nothing went wrong, and nothing but the page itself was asked for.
fn assert_quiet(browser: &mut Browser) {
    assert_eq!(browser.complaints(), Vec::<String>::new());
    let requests = browser.requests();
    assert_eq!(requests.len(), 1, "{requests:?}");
    assert!(requests[0].starts_with("file://") && requests[0].ends_with("report.html"));
}

pub fn a_2d_report_shows_its_particles_and_obeys(program: &Path) {
    let results = Results::new();
    let page = results.of_repository("upwind/column-impact", &[]);
    let mut browser = Browser::start(program, &[]);
    opened(&mut browser, &page);
    browser.shot("2d");
    let last = drawn(&mut browser, "drawing");
    // 225 discs of some 25 pixels, in many colours.
    assert!(last.pixels > 20_000 && last.tones > 50, "{last:?}");
    assert_eq!(
        browser.evaluate("document.getElementById('clock').textContent.includes('1.5 s')"),
        true
    );

    // A click near the start of the time line.
    browser.click("#time", 0.1);
    browser.wait_for("Number(document.getElementById('view').dataset.frame) < 6");
    settled(&mut browser);
    let early = drawn(&mut browser, "drawing");
    assert!(early.pixels > 20_000 && early.shape != last.shape, "{early:?} {last:?}");

    choose(&mut browser, "velocity");
    let velocity = drawn(&mut browser, "drawing");
    assert_eq!(velocity.shape, early.shape);
    assert_ne!(velocity.colours, early.colours);

    // The value under the pointer, in the middle of the column.
    browser.hover("#drawing", [-0.04, 0.1]);
    settled(&mut browser);
    let tip = browser.evaluate(
        "document.getElementById('tip').hidden ? '' : document.getElementById('tip').textContent",
    );
    let tip = tip.as_str().unwrap();
    assert!(tip.contains("velocity.magnitude = ") && tip.contains(" of column"), "{tip}");

    // Another range: everything above 0 has the colour of the top.
    browser.evaluate(
        "(() => { const e = document.getElementById('range'); e.value = 'fixed';
            e.dispatchEvent(new Event('change')); })()",
    );
    browser.evaluate(
        "(() => { for (const [id, v] of [['low', '-2'], ['high', '-1']]) {
            const e = document.getElementById(id); e.value = v; e.dispatchEvent(new Event('input')); } })()",
    );
    settled(&mut browser);
    let clipped = drawn(&mut browser, "drawing");
    // A drawing without a graphics card rounds one colour to a few neighbouring ones.
    assert!(clipped.shape == velocity.shape && clipped.tones <= 4, "{clipped:?}");

    browser.drag("#drawing", [80.0, 0.0]);
    settled(&mut browser);
    assert_ne!(drawn(&mut browser, "drawing").shape, clipped.shape, "dragging moves it");

    browser.click("#play", 0.5);
    let before = browser.evaluate("document.getElementById('view').dataset.frame");
    browser.wait_for(&format!("document.getElementById('view').dataset.frame !== {before}"));

    // Values under the pointer on a chart.
    browser.hover("svg.panel", [0.1, 0.0]);
    let tip = browser.evaluate("document.querySelector('.holder .tip').textContent");
    let tip = tip.as_str().unwrap();
    assert!(tip.contains("time = ") && tip.contains("top.displacement.y = "), "{tip}");
    assert_quiet(&mut browser);
}

pub fn a_3d_report_turns(program: &Path) {
    let results = Results::new();
    let coarse = ["--set", "body.column.spacing=0.5"];
    let page = results.of_repository("upwind/column-impact-3d", &coarse);
    let mut browser = Browser::start(program, &[]);
    opened(&mut browser, &page);
    browser.shot("3d");
    let first = drawn(&mut browser, "drawing");
    // Lit spheres have many shades.
    assert!(first.pixels > 20_000 && first.tones > 500, "{first:?}");
    browser.drag("#drawing", [120.0, 40.0]);
    settled(&mut browser);
    let turned = drawn(&mut browser, "drawing");
    assert!(turned.pixels > 20_000 && turned.shape != first.shape, "{turned:?}");
    browser.shot("3d-turned");
    browser.click("#directions button", 0.5);
    settled(&mut browser);
    assert_eq!(drawn(&mut browser, "drawing"), first, "the first view comes back");
    choose(&mut browser, "velocity");
    let velocity = drawn(&mut browser, "drawing");
    assert!(velocity.shape == first.shape && velocity.colours != first.colours);
    browser.click("#time", 0.3);
    settled(&mut browser);
    assert_ne!(drawn(&mut browser, "drawing").shape, first.shape);
    assert_quiet(&mut browser);
}

pub fn a_1d_report_draws_a_curve_beside_its_reference(program: &Path) {
    let results = Results::new();
    let page = results.of_repository("upwind/bar-step", &[]);
    let mut browser = Browser::start(program, &[]);
    opened(&mut browser, &page);
    let last = drawn(&mut browser, "overlay");
    assert!(last.pixels > 3_000, "{last:?}");
    browser.click("#time", 0.4);
    settled(&mut browser);
    assert_ne!(drawn(&mut browser, "overlay").shape, last.shape);
    assert_eq!(browser.evaluate("document.querySelectorAll('path.reference').length > 1"), true);
    browser.shot("1d");
    assert_quiet(&mut browser);
}

pub fn without_webgl_the_page_says_so_and_shows_pictures(program: &Path) {
    let results = Results::new();
    let page = results.of_repository("upwind/column-impact", &[]);
    let mut browser = Browser::start(program, &["--disable-3d-apis"]);
    browser.open(&page);
    browser.wait_for("document.getElementById('trouble').textContent.includes('WebGL 2')");
    assert_eq!(browser.evaluate("document.getElementById('view').hidden"), true);
    browser.evaluate("document.querySelector('.pictures img').scrollIntoView()");
    browser.wait_for("document.querySelector('.pictures img').naturalWidth > 500");
    assert_eq!(browser.requests().len(), 1);
}

/// A case that fails, and whose every text would be a script if it were not escaped.
const HOSTILE: &str = r#"
version = 1
id = "<b>id</b>"
title = '''</title></script><script>window.hacked = 1</script><img src="x" onerror="window.hacked = 1"> & "quotes"'''
dimension = 2
[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 1.0] }
spacing = 0.25
material = { kind = "linear", density = 1000.0, bulk_modulus = 1e5 }
[scheme]
kind = "upwind"
smoothing_length = 0.7
[time]
end = 0.02
cfl = 0.2
max_steps = 3
[[probe]]
name = "corner"
kind = "particle"
at = [1.0, 1.0]
fields = ["displacement"]
[output]
every = 0.01
[[check]]
quantity = "run.outcome"
expected = "</td><script>window.hacked = 1</script>"
source = "\" onmouseover=\"window.hacked = 1"
"#;

pub fn a_hostile_case_stays_text_and_a_failure_comes_first(program: &Path) {
    let results = Results::new();
    let page = results.of_text(HOSTILE, 3);
    // The names of bodies are plain in any case that runs, but who knows what became of the record.
    let script =
        "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 1'>";
    results.change_record("\"block\"", &format!("\"{script}\""));
    let mut browser = Browser::start(program, &[]);
    opened(&mut browser, &page);
    let title = "document.querySelector('h1').textContent";
    let start = browser.evaluate(title);
    assert!(start.as_str().unwrap().starts_with("</title></script><script>"), "{start}");
    browser.hover("#drawing", [-0.05, 0.0]);
    browser.hover("svg.panel", [0.1, 0.0]);
    settled(&mut browser);
    assert_eq!(browser.evaluate("typeof window.hacked"), "undefined");
    assert_eq!(
        browser.evaluate("document.querySelectorAll('img[src=x], h1 *, h1 script').length"),
        0
    );
    let first = browser.evaluate("document.querySelector('main > section').id");
    assert_eq!(first, "failure");
    let message = browser.evaluate("document.getElementById('failure').textContent");
    assert!(message.as_str().unwrap().contains("time.max_steps"), "{message}");
    browser.shot("failed");
    assert_quiet(&mut browser);
}
