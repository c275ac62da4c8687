//! SPDX expressions: whether one of the choices of a licence is allowed.

/// Licences under which a dependency may be given away with the program.
const ALLOWED: [&str; 17] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "MIT-0",
    "MPL-2.0",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Whether an expression can be satisfied by allowed licences. Old manifests write `/` for OR.
pub(super) fn is_allowed(expression: &str) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut parser = Parser { words: &words, place: 0 };
    parser.any() == Some(true) && parser.place == words.len()
}

struct Parser<'a> {
    words: &'a [&'a str],
    place: usize,
}

impl Parser<'_> {
    /// a OR b …
    fn any(&mut self) -> Option<bool> {
        let mut is_allowed = self.all()?;
        while self.takes("OR") {
            is_allowed |= self.all()?;
        }
        Some(is_allowed)
    }

    /// a AND b …
    fn all(&mut self) -> Option<bool> {
        let mut is_allowed = self.one()?;
        while self.takes("AND") {
            is_allowed &= self.one()?;
        }
        Some(is_allowed)
    }

    fn one(&mut self) -> Option<bool> {
        if self.takes("(") {
            let is_allowed = self.any()?;
            return self.takes(")").then_some(is_allowed);
        }
        let mut name = (*self.words.get(self.place)?).to_owned();
        self.place += 1;
        if self.takes("WITH") {
            name += &format!(" WITH {}", self.words.get(self.place)?);
            self.place += 1;
        }
        Some(ALLOWED.contains(&name.as_str()))
    }

    fn takes(&mut self, word: &str) -> bool {
        let is_next = self.words.get(self.place) == Some(&word);
        self.place += usize::from(is_next);
        is_next
    }
}

#[cfg(test)]
mod tests {
    use super::is_allowed;

    #[test]
    fn one_allowed_choice_is_enough_and_every_part_is_needed() {
        for expression in [
            "MIT",
            "MIT/Apache-2.0",
            "Apache-2.0 OR GPL-3.0",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR MIT",
        ] {
            assert!(is_allowed(expression), "{expression}");
        }
        for expression in ["GPL-3.0", "MIT AND GPL-2.0", "", "MIT OR", "(MIT", "MIT Apache-2.0"] {
            assert!(!is_allowed(expression), "{expression}");
        }
    }
}
