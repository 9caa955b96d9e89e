//! The members of a sweep, from the command line or from the case file.

use piola::case::sweep::{MemberResult, MemberValue, folder_names, split_values};
use piola::case::{Case, Level, LoadOptions, load};

use crate::arguments::SweepArguments;
use crate::commands::{overrides, refusal};
use crate::exit::{Exit, Fault};

/// Members that a sweep of the command line may have.
const MAX_MEMBERS: usize = 1000;

/// A member that is read and can be built.
pub struct Member {
    /// Name of its folder.
    pub name: String,
    /// The value of each key.
    pub values: Vec<MemberValue>,
    /// The case with these values.
    pub case: Case,
}

impl Member {
    /// Its row before it runs.
    pub fn waiting(&self) -> MemberResult {
        MemberResult {
            name: self.name.clone(),
            values: self.values.clone(),
            outcome: "not run".to_owned(),
            seconds: None,
            finished: None,
        }
    }
}

/// The keys and the members. All are read before the first one runs, so that a wrong value is
/// refused at once.
pub fn members(arguments: &SweepArguments) -> Result<(Vec<String>, Vec<Member>), Fault> {
    match &arguments.sweep {
        Some(name) => of_case(arguments, name),
        None => of_flags(arguments),
    }
}

fn read(arguments: &SweepArguments, options: &LoadOptions) -> Result<Case, Fault> {
    let path = &arguments.case.file.case;
    load(path, options).map_err(|problems| refusal(path, &problems))
}

/// The members of the sweep called `name` of the case file.
fn of_case(arguments: &SweepArguments, name: &str) -> Result<(Vec<String>, Vec<Member>), Fault> {
    let changes = overrides(&arguments.case);
    let options =
        |variant| LoadOptions { overrides: changes.clone(), variant, ..LoadOptions::default() };
    // The first member is there if the sweep is; a wrong name is explained by reading it.
    let first = read(arguments, &options(Some(format!("{name}.1"))))?;
    let Some(sweep) = first.sweeps.iter().find(|sweep| *sweep.name == name) else {
        return Err(Fault::new(Exit::BadCase, format!("the case has no sweep `{name}`")));
    };
    let keys = sweep.keys(Level::Case);
    let values = |index: usize| -> Vec<(&str, &str)> {
        let numbers = piola::case::model::coordinates(keys, index);
        let each = keys.iter().zip(numbers);
        each.map(|(key, number)| (key.path.as_str(), key.values[number].text.as_str())).collect()
    };
    let all: Vec<_> = (0..sweep.count(Level::Case)).map(values).collect();
    let mut members = Vec::new();
    for (index, (folder, values)) in folder_names(&all).into_iter().zip(&all).enumerate() {
        let case = read(arguments, &options(Some(sweep.member(index))))?;
        let values = values.iter().map(|(_, text)| MemberValue::new(text, &case)).collect();
        members.push(Member { name: folder, values, case });
    }
    if members.is_empty() {
        let message = format!("the sweep `{name}` has no members in the case as it stands");
        return Err(Fault::new(Exit::BadCase, message));
    }
    Ok((keys.iter().map(|key| key.path.value.clone()).collect(), members))
}

/// Every value, or pair of values, of the flags `--over`.
fn of_flags(arguments: &SweepArguments) -> Result<(Vec<String>, Vec<Member>), Fault> {
    let fault = |message: String| Fault::new(Exit::BadCase, message);
    let mut keys: Vec<(&str, Vec<&str>)> = Vec::new();
    for flag in &arguments.over {
        let Some((key, values)) = flag.split_once('=') else {
            let form = "it has the form path.to.key=value1,value2";
            return Err(fault(format!("--over {flag}: {form}")));
        };
        let values = split_values(values);
        if values.iter().any(|value| value.is_empty()) {
            return Err(fault(format!("--over {flag}: a value is empty")));
        }
        if keys.iter().any(|(known, _)| *known == key.trim()) {
            return Err(fault(format!("--over {flag}: the key appears twice")));
        }
        keys.push((key.trim(), values));
    }
    if keys.len() > 2 {
        let message = "--over is given more than twice; a sweep varies one or two keys";
        return Err(fault(message.to_owned()));
    }
    let count = keys.iter().fold(1_usize, |count, (_, values)| count.saturating_mul(values.len()));
    if count > MAX_MEMBERS {
        let message = format!("the sweep has {count} members, at most {MAX_MEMBERS} are allowed");
        return Err(fault(message));
    }
    let mut all: Vec<Vec<(&str, &str)>> = vec![Vec::new()];
    for (key, values) in &keys {
        let longer = |member: Vec<_>| {
            values.iter().map(move |value| {
                let mut member = member.clone();
                member.push((*key, *value));
                member
            })
        };
        all = all.into_iter().flat_map(longer).collect();
    }
    let mut members = Vec::new();
    for (name, values) in folder_names(&all).into_iter().zip(&all) {
        let mut overrides = overrides(&arguments.case);
        overrides.extend(values.iter().map(|(key, value)| format!("{key}={value}")));
        let variant = arguments.case.file.variant.clone();
        let case = read(arguments, &LoadOptions { overrides, variant, ..LoadOptions::default() })?;
        let values = values.iter().map(|(_, text)| MemberValue::new(text, &case)).collect();
        members.push(Member { name, values, case });
    }
    Ok((keys.into_iter().map(|(key, _)| key.to_owned()).collect(), members))
}
