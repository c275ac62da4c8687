//! The content security policy of the page: it loads nothing, and runs no script but its own.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

/// A policy that allows exactly this style and this script, and pictures and sound inside the page.
pub(crate) fn policy(style: &str, script: &str) -> String {
    let hash = |text: &str| STANDARD.encode(Sha256::digest(text.as_bytes()));
    format!(
        "default-src 'none'; img-src data:; media-src data:; style-src 'sha256-{}'; script-src 'sha256-{}'",
        hash(style),
        hash(script)
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_policy_names_the_hashes() {
        // SHA-256 of the empty text, in base64
        let nothing = "47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=";
        let policy = super::policy("", "a");
        assert!(policy.contains(&format!("style-src 'sha256-{nothing}'")), "{policy}");
        assert!(!policy.contains("unsafe"));
    }
}
