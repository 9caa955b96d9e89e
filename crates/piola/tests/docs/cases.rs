//! The gallery of cases, the page of each case, and the case files that pages show.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use piola::case::{LoadOptions, Session, parse};

use super::pages::{Page, all, below, page, root};

/// Largest picture beside a case in bytes: clones stay small.
const LARGEST_PICTURE: u64 = 200_000;
/// Width of charts in pixels, which have no colour bar.
const CHART: usize = 1200;
/// How many colours follow one another on a colour bar at least, and by how much of 255 neighbours may differ: fewer and
/// larger steps are seen as bands.
const COLOURS: usize = 100;
const STEP: u8 = 8;

/// The folder of each case with its id.
fn cases() -> BTreeSet<(String, String)> {
    let folder = |name: &str| name.trim_end_matches("/case.toml").to_owned();
    let files = below("cases", &["/case.toml"]).into_iter().map(|file| {
        let case: toml::Table = file.text.parse().expect("case files are TOML");
        let id = case.get("id").and_then(toml::Value::as_str).unwrap_or_default();
        (folder(&file.name), id.to_owned())
    });
    files.collect()
}

/// The rows of the gallery: the folder and the id of the case, and the picture.
fn rows() -> Vec<(String, String, String)> {
    let gallery = page("docs/gallery.md");
    let row = |line: &str| {
        let mut columns = line.strip_prefix("| <img src=\"../")?.split(" | ");
        let (picture, case) = (columns.next()?.split('"').next()?, columns.next()?);
        let (id, link) = case.split_once(" [")?;
        let folder = link.split_once("](../")?.1.split(')').next()?;
        Some((folder.to_owned(), id.to_owned(), picture.to_owned()))
    };
    gallery.text.lines().filter_map(row).collect()
}

#[test]
fn the_gallery_lists_all_cases_once_with_their_pictures() {
    let rows = rows();
    let listed = rows.iter().map(|(folder, id, _)| (folder.clone(), id.clone()));
    assert_eq!(listed.collect::<BTreeSet<_>>(), cases());
    assert_eq!(rows.len(), cases().len(), "a case has two rows");
    for (folder, _, picture) in rows {
        assert_eq!(picture, format!("{folder}/picture.png"));
    }
}

#[test]
fn each_case_has_a_page_with_its_command_and_picture() {
    for (folder, id) in cases() {
        let page = page(&format!("{folder}/README.md"));
        assert!(page.text.starts_with(&format!("# {id}: ")), "{}", page.name);
        let command = format!("cargo run --release -- run {folder}/case.toml");
        assert!(page.text.contains(&command), "{} lacks `{command}`", page.name);
        assert!(page.text.contains("](picture.png)"), "{} shows no picture", page.name);
        assert!(root().join(&folder).join("picture.png").is_file(), "{folder} has no picture");
    }
}

/// The pictures beside the cases.
fn pictures() -> Vec<String> {
    let names = |folder: String| {
        let files = fs::read_dir(root().join(&folder)).expect("a case lies in a folder");
        let names = files.map(|file| file.expect("it can be read").file_name());
        let names = names.filter_map(|name| name.into_string().ok());
        let names = names.filter(|name| name.ends_with(".png"));
        names.map(move |name| format!("{folder}/{name}")).collect::<Vec<_>>()
    };
    cases().into_iter().flat_map(|(folder, _)| names(folder)).collect()
}

/// The width of a picture and its pixels, row by row.
fn pixels(path: &Path) -> (usize, Vec<[u8; 3]>) {
    let file = File::open(path).expect("it can be read");
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().expect("it is a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("it fits into memory")];
    let info = reader.next_frame(&mut bytes).expect("it is a PNG");
    let samples = info.color_type.samples();
    assert!(samples >= 3, "{} is not in colour", path.display());
    let pixels = bytes[..info.buffer_size()].chunks_exact(samples);
    (info.width as usize, pixels.map(|part| [part[0], part[1], part[2]]).collect())
}

/// The most changes of colour along a line of pixels none of which is larger than `STEP`.
fn small_changes<'a>(mut line: impl Iterator<Item = &'a [u8; 3]>) -> usize {
    let Some(mut before) = line.next() else { return 0 };
    let (mut most, mut count) = (0, 0);
    for pixel in line {
        let change = pixel.iter().zip(before).map(|(one, other)| one.abs_diff(*other)).max();
        count = match change {
            Some(0) => count,
            Some(change) if change <= STEP => count + 1,
            _ => 0,
        };
        most = most.max(count);
        before = pixel;
    }
    most
}

#[test]
fn pictures_of_cases_are_small_and_have_smooth_colours() {
    for name in pictures() {
        let path = root().join(&name);
        let size = fs::metadata(&path).expect("it is there").len();
        assert!(size < LARGEST_PICTURE, "{name} has {size} bytes");
        let (width, pixels) = pixels(&path);
        if width == CHART {
            continue;
        }
        let rows = pixels.chunks_exact(width).map(|row| small_changes(row.iter()));
        let columns = (0..width).map(|x| small_changes(pixels.iter().skip(x).step_by(width)));
        let most = rows.chain(columns).max().unwrap_or_default();
        assert!(most >= COLOURS, "the colour bar of {name} has bands: {most} colours in a row");
    }
}

/// The whole case files that a page shows.
fn shown(page: &Page) -> Vec<&str> {
    let blocks = page.text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.starts_with("version = 1")).collect()
}

#[test]
fn cases_that_pages_show_are_good_ones() {
    let mut count = 0;
    for page in all() {
        for text in shown(&page) {
            let case = parse(text, &page.name, &LoadOptions::default());
            let case = case.unwrap_or_else(|problems| panic!("{}:\n{problems}", page.name));
            let session = Session::new(&case);
            let session = session.unwrap_or_else(|problems| panic!("{}:\n{problems}", page.name));
            assert!(!session.case().probes.is_empty(), "{}", page.name);
            count += 1;
        }
    }
    // One in the page about making a case, one in that about convergence, and one a tutorial.
    let tutorials = below("docs/tutorials", &[".md"]);
    assert!(tutorials.iter().all(|page| shown(page).len() == 1), "a tutorial shows a case");
    assert!(count >= tutorials.len() + 2, "{count}");
}
