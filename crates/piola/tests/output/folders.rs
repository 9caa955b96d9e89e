//! The folder of results and the record in it.

use std::fs;
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

use piola::output::{
    BodyRecord, OutputError, RecordError, ResultsFolder, RunRecord, StageRecord, timestamp,
};
use proptest::prelude::*;

fn record() -> RunRecord {
    RunRecord { title: "A bar".into(), ..RunRecord::default() }
}

fn touch(path: &Path) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, "older").unwrap();
}

#[test]
fn a_new_folder_is_created_and_known_at_once() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("a/b/results");
    let folder = ResultsFolder::create(&path, &record()).unwrap();
    assert_eq!(folder.path(), path);
    // As a run that is killed leaves it.
    assert_eq!(RunRecord::read(&path.join("run.json")).unwrap().outcome, "running");
    assert_eq!(fs::read_dir(&path).unwrap().count(), 1);
    assert_eq!(folder.particles(12).unwrap(), path.join("particles/frame_000012.vtp"));
    assert_eq!(folder.picture("pressure", 3).unwrap(), path.join("pictures/pressure_000003.png"));
    assert_eq!(folder.plot("end").unwrap(), path.join("plots/end.png"));
    assert_eq!(folder.probes(), path.join("probes.csv"));
    assert_eq!(folder.energy(), path.join("energy.csv"));
    assert_eq!(folder.steps(), path.join("steps.csv"));
    assert_eq!(folder.series(), path.join("particles.pvd"));
    let frame = folder.particles(1_234_567).unwrap();
    assert_eq!(folder.relative(&frame), "particles/frame_1234567.vtp");
    ResultsFolder::create(&path, &record()).unwrap();
}

#[test]
fn names_of_users_stay_in_the_folder() {
    let parent = tempfile::tempdir().unwrap();
    let folder = ResultsFolder::create(&parent.path().join("r"), &record()).unwrap();
    for name in ["../../evil", "/etc/passwd", "..", "", "a\0b", "tip über é", &"x".repeat(5000)] {
        let path = folder.plot(name).unwrap();
        assert_eq!(path.parent().unwrap(), folder.path().join("plots"), "{name}");
        fs::write(&path, "").unwrap();
    }
}

#[test]
fn the_files_of_an_earlier_run_go_and_other_files_stay() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("r");
    let outside = parent.path().join("outside.txt");
    touch(&outside);
    let earlier = RunRecord {
        files: ["plots/end.png", "report.html", "../outside.txt", "/etc/none", "run.json", "gone"]
            .map(String::from)
            .to_vec(),
        ..record()
    };
    let folder = ResultsFolder::create(&path, &earlier).unwrap();
    let stale = [
        folder.particles(7).unwrap(),
        folder.picture("pressure", 7).unwrap(),
        folder.plot("end").unwrap(),
        folder.series(),
        folder.probes(),
        path.join("report.html"),
        path.join("particles/.piola-abc.partial"),
        path.join(".piola-abc.partial"),
    ];
    let kept = [
        path.join("notes.txt"),
        path.join("particles/mine.vtp"),
        path.join("pictures/figure 3.png"),
        path.join("plots/own.png"),
        outside,
    ];
    stale.iter().chain(&kept).for_each(|file| touch(file));
    ResultsFolder::create(&path, &record()).unwrap();
    for file in stale {
        assert!(!file.exists(), "{}", file.display());
    }
    for file in kept {
        assert!(file.exists(), "{}", file.display());
    }
    assert_eq!(RunRecord::read(&path.join("run.json")).unwrap(), record());
}

#[test]
fn a_folder_of_somebody_else_is_refused_untouched() {
    let parent = tempfile::tempdir().unwrap();
    for foreign in ["thesis.tex", "particles.pvd"] {
        let path = parent.path().join(foreign.replace('.', "-"));
        touch(&path.join(foreign));
        let error = ResultsFolder::create(&path, &record()).unwrap_err();
        assert!(matches!(&error, OutputError::ForeignFolder { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains(foreign) && text.contains("--out") && text.contains("empty"));
        assert_eq!(fs::read_to_string(path.join(foreign)).unwrap(), "older");
        assert_eq!(fs::read_dir(&path).unwrap().count(), 1);
    }
    // A record of another program is none.
    let path = parent.path().join("other");
    touch(&path.join("run.json"));
    fs::write(path.join("run.json"), r#"{"program": "other"}"#).unwrap();
    let error = ResultsFolder::create(&path, &record()).unwrap_err();
    assert!(matches!(error, OutputError::ForeignFolder { .. }), "{error}");
}

#[test]
fn a_file_in_the_place_of_a_folder_is_named() {
    let parent = tempfile::tempdir().unwrap();
    let file = parent.path().join("file");
    touch(&file);
    for path in [file.clone(), file.join("below"), file.join("far/below")] {
        let error = ResultsFolder::create(&path, &record()).unwrap_err();
        let OutputError::NotAFolder { path } = &error else { panic!("{error}") };
        assert_eq!(*path, file);
    }
    let folder = ResultsFolder::create(&parent.path().join("r"), &record()).unwrap();
    touch(&folder.path().join("particles"));
    let error = folder.particles(0).unwrap_err();
    assert!(matches!(error, OutputError::NotAFolder { .. }), "{error}");
}

#[cfg(unix)]
#[test]
fn links_are_not_followed_when_files_go() {
    let parent = tempfile::tempdir().unwrap();
    let precious = parent.path().join("precious");
    touch(&precious.join("frame_000001.vtp"));
    let path = parent.path().join("r");
    let files = vec!["particles/frame_000001.vtp".into()];
    ResultsFolder::create(&path, &RunRecord { files, ..record() }).unwrap();
    std::os::unix::fs::symlink(&precious, path.join("particles")).unwrap();
    ResultsFolder::create(&path, &record()).unwrap();
    assert!(precious.join("frame_000001.vtp").exists());
}

#[test]
fn a_record_reads_back_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.json");
    let record = RunRecord {
        case_text: "version = 1\n# \"quoted\" and é\n".into(),
        id: Some("U10".into()),
        overrides: vec!["time.end=0.5".into()],
        seeds: vec![u64::MAX],
        threads: 8,
        dimension: 2,
        bodies: vec![BodyRecord { name: "column".into(), particles: 273, spacing: vec![0.1, 0.2] }],
        finished: Some(timestamp(UNIX_EPOCH)),
        outcome: "failed: inverted".into(),
        steps: 12,
        end_time: 0.1 + 0.2,
        time_reached: 1.0 / 3.0,
        stages: vec![StageRecord {
            name: "rates".into(),
            seconds: 0.25,
            calls: 24,
            bytes: Some(8e6),
        }],
        files: vec!["particles.pvd".into()],
        warnings: vec!["few neighbours".into()],
        ..record()
    };
    record.write(&path).unwrap();
    assert_eq!(RunRecord::read(&path).unwrap(), record);
    // JSON has no NaN; a failed run may well have one.
    RunRecord { time_reached: f64::NAN, ..record }.write(&path).unwrap();
    assert!(RunRecord::read(&path).unwrap().time_reached.is_nan());
    // A record of another version: a key less, a key more.
    fs::write(&path, r#"{"program": "piola", "steps": 3, "unheard_of": [1]}"#).unwrap();
    assert_eq!(RunRecord::read(&path).unwrap().steps, 3);
    for text in ["", "{}", "[]", r#"{"program": "other"}"#, r#"{"program": "piola", "steps": -1}"#]
    {
        fs::write(&path, text).unwrap();
        let error = RunRecord::read(&path).unwrap_err();
        assert!(!matches!(error, RecordError::Io { .. }), "{text}: {error}");
    }
}

#[test]
fn times_are_written_in_utc() {
    let at = |seconds| timestamp(UNIX_EPOCH + Duration::from_secs(seconds));
    assert_eq!(at(0), "1970-01-01T00:00:00Z");
    // 2024-02-29 12:34:56, as `date -u -d @1709210096` says.
    assert_eq!(at(1_709_210_096), "2024-02-29T12:34:56Z");
    assert_eq!(at(u64::MAX >> 2), "9999-12-31T23:59:59Z");
    assert_eq!(timestamp(UNIX_EPOCH - Duration::from_secs(9)), "1970-01-01T00:00:00Z");
}

proptest! {
    // Each case writes and reads a file.
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_record_makes_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        fs::write(&path, &bytes).unwrap();
        let _ = RunRecord::read(&path);
    }
}
