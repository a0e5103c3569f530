//! The known name that looks most like an unknown one.

/// The candidate that `name` most probably meant, if any is alike: one begins with the other, or at most a third
/// of the letters differ.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| {
            let begins = name.len().min(candidate.len()) >= 3
                && (candidate.starts_with(name) || name.starts_with(candidate));
            begins || *distance <= (name.chars().count().max(candidate.chars().count()) / 3).max(1)
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance in characters: insertions, deletions and substitutions each count one.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    // row[j]: distance between the part of `from` read so far and the first j characters of `to`.
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, c) in from.chars().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, d) in to.iter().enumerate() {
            let substituted = diagonal + usize::from(c != *d);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        for (a, b, d) in [("", "", 0), ("a", "", 1), ("kitten", "sitting", 3), ("flaw", "lawn", 2)] {
            assert_eq!(distance(a, b), d);
            assert_eq!(distance(b, a), d);
        }
    }

    #[test]
    fn offers_only_what_looks_alike() {
        let keys = ["velocity_deg_s", "position_min_deg", "jerk_deg_s3"];
        let offered = |name| nearest(name, keys.into_iter());
        assert_eq!(offered("velocty_deg_s"), Some("velocity_deg_s"));
        assert_eq!(offered("velocity"), Some("velocity_deg_s"));
        assert_eq!(offered("velocity_rad_s"), Some("velocity_deg_s"));
        assert_eq!(offered("colour"), None);
    }
}
