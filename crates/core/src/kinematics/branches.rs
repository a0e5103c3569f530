//! A short list on the stack.

/// Up to MAX branches of an inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branches<S, const MAX: usize> {
    items: [S; MAX],
    count: usize,
}

impl<S: Copy, const MAX: usize> Branches<S, MAX> {
    /// No branch yet; the places hold `nothing`.
    #[inline]
    pub(super) fn none(nothing: S) -> Self {
        Self { items: [nothing; MAX], count: 0 }
    }

    /// Adds a branch. There are never more than MAX.
    #[inline]
    pub(super) fn push(&mut self, branch: S) {
        if let Some(place) = self.items.get_mut(self.count) {
            *place = branch;
            self.count += 1;
        }
    }

    /// The branches.
    #[inline]
    #[must_use]
    pub fn as_slice(&self) -> &[S] {
        self.items.get(..self.count).unwrap_or(&[])
    }
}
