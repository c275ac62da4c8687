//! Advice in the words of a command that says facts in another way than by the flags of `hovertone speed`.

/// What a command has in place of flags that advice names: pairs of a flag, with words around it, and what to say. The first pairs are
/// replaced first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wording(pub &'static [(&'static str, &'static str)]);

impl Wording {
    /// The advice in these words.
    pub fn of(self, advice: &str) -> String {
        self.0.iter().fold(advice.to_owned(), |advice, (flag, words)| advice.replace(flag, words))
    }
}
