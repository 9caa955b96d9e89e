//! The commented case that a user starts from.

const TEXT: &str = include_str!("template.toml");

/// The text of a new case called `name`: a small 2D impact with every common key explained.
pub fn new_case(name: &str) -> String {
    // The title is TOML text: what would end or escape it is left out.
    let name: String = name.chars().filter(|c| !c.is_control() && !"\"\\".contains(*c)).collect();
    TEXT.replace("{name}", &name)
}
