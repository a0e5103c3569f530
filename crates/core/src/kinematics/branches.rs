//! A short list on the stack, and the nearest of several joint positions.

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

    /// One branch.
    pub(super) fn one(branch: S) -> Self {
        Self { items: [branch; MAX], count: 1 }
    }

    /// Each branch as something else.
    #[inline]
    pub(super) fn map<T>(self, f: impl FnMut(S) -> T) -> Branches<T, MAX> {
        Branches { items: self.items.map(f), count: self.count }
    }

    /// The branches, to be put in order.
    pub(super) fn as_mut_slice(&mut self) -> &mut [S] {
        self.items.get_mut(..self.count).unwrap_or(&mut [])
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

impl<S, const MAX: usize> IntoIterator for Branches<S, MAX> {
    type Item = S;
    type IntoIter = core::iter::Take<core::array::IntoIter<S, MAX>>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.into_iter().take(self.count)
    }
}

/// The joint positions nearest to `seed` by the sum of squared differences.
#[inline]
pub(super) fn nearest<const N: usize>(
    candidates: impl Iterator<Item = [f64; N]>,
    seed: &[f64; N],
) -> Option<[f64; N]> {
    let mut best = None;
    for q in candidates {
        let distance = distance_squared(&q, seed);
        if best.is_none_or(|(_, least)| distance < least) {
            best = Some((q, distance));
        }
    }
    best.map(|(q, _)| q)
}

/// Σ (aᵢ − bᵢ)².
#[inline]
pub(super) fn distance_squared<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}
