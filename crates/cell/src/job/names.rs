//! The nearest known name for one that is not known.

use super::error::Nearest;

/// Longer names are compared up to this length, so that the cost is bounded.
const MAX_LENGTH: usize = 40;

/// The candidate with the fewest changed letters, where they are few enough to be a slip: a third of the name.
pub(super) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Nearest {
    let limit = (name.chars().count().min(MAX_LENGTH) / 3).clamp(1, 3);
    let best = candidates
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(d, _)| *d <= limit)
        .min_by_key(|(d, _)| *d);
    Nearest(best.map(|(_, candidate)| candidate.to_owned()))
}

/// Least number of letters changed, added, dropped or swapped with the next one (optimal string alignment);
/// upper and lower case count as the same.
fn distance(left: &str, right: &str) -> usize {
    let letters = |s: &str| s.chars().take(MAX_LENGTH).map(|c| c.to_ascii_uppercase()).collect::<Vec<char>>();
    let (left, right) = (letters(left), letters(right));
    let mut two_back: Vec<usize> = vec![0; right.len() + 1];
    let mut above: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in right.iter().enumerate() {
            let mut best = (above[j] + usize::from(a != b)).min(above[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *a == right[j - 1] && left[i - 1] == *b {
                best = best.min(two_back[j - 1] + 1);
            }
            row.push(best);
        }
        two_back = std::mem::replace(&mut above, row);
    }
    above.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_other_words_are_not() {
        let find = |name, list: &[&str]| nearest(name, list.iter().copied()).0;
        assert_eq!(find("MVOL", &["MOVJ", "MOVL", "MOVC"]), Some("MOVL".into()));
        assert_eq!(find("fillet-1", &["FILLET-2", "FILLET-1"]), Some("FILLET-1".into()));
        assert_eq!(find("HOME", &["START", "WELD"]), None);
        assert_eq!(find("", &["ABC"]), None);
    }

    #[test]
    fn distances_of_textbook_pairs() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("abcd", "abdc"), 1);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("abc", "ABC"), 0);
    }
}
