//! The content security policy of the page.
//!
//! The page may load nothing and run nothing but its own scripts, which the policy names by their
//! hash: text from a case could not become a script even if it were not escaped.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

/// The policy that allows these styles and `scripts` and the pictures inside the page.
pub fn policy(style: &str, scripts: &[&str]) -> String {
    let scripts: Vec<String> = scripts.iter().map(|script| hash(script)).collect();
    format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data: blob:; \
         style-src {}; script-src {}",
        hash(style),
        scripts.join(" ")
    )
}

fn hash(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())))
}

#[cfg(test)]
mod tests {
    /// The digest of the empty text is published with the standard, FIPS 180-4.
    #[test]
    fn hashes_are_those_of_browsers() {
        assert_eq!(super::hash(""), "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
    }
}
