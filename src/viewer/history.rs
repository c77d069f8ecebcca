//! What can be undone and done again.

/// Versions of something before and after the one that is held elsewhere.
#[derive(Clone, Debug, Default)]
pub struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    gesture: Option<String>,
}

impl<T> History<T> {
    /// Nothing to undo.
    pub fn new() -> Self {
        Self { past: Vec::new(), future: Vec::new(), gesture: None }
    }

    /// Notes what was before a step. Steps of one gesture (a drag of one slider) in a row are one.
    pub fn record(&mut self, before: T, gesture: Option<&str>) {
        let goes_on = gesture.is_some() && self.gesture.as_deref() == gesture;
        if !goes_on {
            self.past.push(before);
        }
        self.gesture = gesture.map(str::to_owned);
        self.future.clear();
    }

    /// Lets the next step be one of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// What was before the last step, in exchange for what is now.
    pub fn undo(&mut self, now: T) -> Result<T, T> {
        self.end_gesture();
        Self::exchange(&mut self.past, &mut self.future, now)
    }

    /// What was before the last [`History::undo`], in exchange for what is now.
    pub fn redo(&mut self, now: T) -> Result<T, T> {
        self.end_gesture();
        Self::exchange(&mut self.future, &mut self.past, now)
    }

    fn exchange(from: &mut Vec<T>, to: &mut Vec<T>, now: T) -> Result<T, T> {
        match from.pop() {
            None => Err(now),
            Some(then) => {
                to.push(now);
                Ok(then)
            }
        }
    }

    /// Whether there is a step to undo, and one to do again.
    pub fn possible(&self) -> [bool; 2] {
        [!self.past.is_empty(), !self.future.is_empty()]
    }

    /// Every version that is kept.
    pub fn versions(&mut self) -> impl Iterator<Item = &mut T> {
        self.past.iter_mut().chain(&mut self.future)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gesture_is_one_step_and_a_new_one_forgets_what_was_undone() {
        let mut history = History::new();
        history.record(0, Some("a"));
        history.record(1, Some("a"));
        history.record(2, Some("b"));
        history.end_gesture();
        history.record(3, Some("b"));
        history.record(4, None);
        history.record(5, None);
        // Now 6; steps from 0, 2, 3, 4 and 5.
        assert_eq!(history.undo(6), Ok(5));
        assert_eq!(history.undo(5), Ok(4));
        assert_eq!(history.undo(4), Ok(3));
        assert_eq!(history.redo(3), Ok(4));
        assert_eq!(history.possible(), [true, true]);
        assert_eq!(history.versions().count(), 5);
        history.record(4, Some("b"));
        assert_eq!(history.redo(7), Err(7));
        assert_eq!(history.undo(7), Ok(4));
        assert_eq!(history.undo(4), Ok(3));
        assert_eq!(history.undo(3), Ok(2));
        assert_eq!(history.undo(2), Ok(0));
        assert_eq!(history.undo(0), Err(0));
        assert_eq!(history.possible(), [false, true]);
    }
}
