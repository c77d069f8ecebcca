//! Which shaders pictures are drawn with: those that are wanted, unless the device has refused them.

use crate::shaders::ShaderSet;

/// What is known of shaders so far.
#[derive(Default)]
pub struct Tried {
    /// Those that something whole was drawn with last.
    good: ShaderSet,
    /// Those that were refused last, and why.
    refused: Option<(ShaderSet, String)>,
}

impl Tried {
    /// What to draw with where `wanted` is wanted.
    pub fn instead_of(&self, wanted: &ShaderSet) -> ShaderSet {
        if self.why_not(wanted).is_some() { self.good.clone() } else { wanted.clone() }
    }

    /// Why it is not what is wanted, if it is not.
    pub fn why_not(&self, wanted: &ShaderSet) -> Option<&str> {
        self.refused.as_ref().filter(|(refused, _)| refused == wanted).map(|(_, why)| why.as_str())
    }

    /// Something was drawn with these.
    pub fn drew(&mut self, shaders: &ShaderSet) {
        self.good = shaders.clone();
    }

    /// The device refuses what is drawn with where `wanted` is wanted; whether there is anything else.
    pub fn refuse(&mut self, wanted: &ShaderSet, why: &str) -> bool {
        let refused = self.instead_of(wanted);
        if refused == self.good {
            self.good = ShaderSet::default();
        }
        if refused == *wanted {
            self.refused = Some((refused.clone(), why.to_owned()));
        }
        !refused.is_embedded()
    }

    /// What was refused for one scene may do for another.
    pub fn try_again(&mut self) {
        self.refused = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn set(word: u32) -> ShaderSet {
        ShaderSet::replacing(BTreeMap::from([("passes/tonemap.comp".to_owned(), vec![word])]))
    }

    #[test]
    fn it_goes_back_to_what_was_drawn_with_and_then_to_what_is_embedded() {
        let mut tried = Tried::default();
        assert!(tried.instead_of(&set(1)) == set(1));
        tried.drew(&set(1));
        assert!(tried.refuse(&set(2), "no"));
        assert!(tried.instead_of(&set(2)) == set(1) && tried.why_not(&set(2)) == Some("no"));
        assert!(tried.instead_of(&set(3)) == set(3) && tried.why_not(&set(3)).is_none());
        // What was good is not for this scene.
        assert!(tried.refuse(&set(2), "neither"));
        assert!(tried.instead_of(&set(2)).is_embedded() && tried.why_not(&set(2)) == Some("no"));
        assert!(!tried.refuse(&set(2), "nothing is left"));
        tried.try_again();
        assert!(tried.instead_of(&set(2)) == set(2));
        // Refused after it was drawn with.
        tried.drew(&set(2));
        assert!(tried.refuse(&set(2), "no more") && tried.instead_of(&set(2)).is_embedded());
        assert!(!Tried::default().refuse(&ShaderSet::default(), "of this build"));
    }
}
