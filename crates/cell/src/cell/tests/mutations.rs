//! Random damage to a cell file: always a cell or one error in the file itself, never a panic.

use super::*;

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

fn check(text: &str) -> bool {
    match Cell::parse(text, "cell.toml") {
        Ok(cell) => {
            assert!(!cell.robot.joints.is_empty() && cell.cycle.period > 0.0);
            true
        }
        Err(error) => {
            assert_eq!(error.file, "cell.toml", "{error}\n{text}");
            let (line, column) = error.place.unwrap();
            let found = text.split('\n').nth(line - 1).unwrap_or_else(|| panic!("{error}\n{text}"));
            assert!((1..=found.chars().count() + 1).contains(&column), "{error}\n{text}");
            false
        }
    }
}

/// 3000 copies of the default file, each with one to four bytes changed, put in or taken out.
#[test]
fn damaged_bytes() {
    let bytes = b"[]{}=\"'#.,\n\r\t -+_eE0123456789abcxinfnan\\\xC3\xA4\x00";
    let mut random = Random(1);
    let mut accepted = 0;
    for _ in 0..3000 {
        let mut text = DEFAULT_CELL_TOML.as_bytes().to_vec();
        for _ in 0..=random.below(4) {
            let at = random.below(text.len());
            let byte = bytes[random.below(bytes.len())];
            match random.below(3) {
                0 => text[at] = byte,
                1 => text.insert(at, byte),
                _ => drop(text.remove(at)),
            }
        }
        accepted += usize::from(check(&String::from_utf8_lossy(&text)));
    }
    // Damage to a comment or a digit may leave a right file.
    assert!((300..2700).contains(&accepted), "{accepted}");
}

/// 3000 copies of the default file, each with one to three values or whole lines replaced by something else.
#[test]
fn damaged_values() {
    let values = [
        "nan",
        "-inf",
        "1e400",
        "-1",
        "0",
        "1e-320",
        "99999999999999999999",
        "0x1F",
        "true",
        "\"\"",
        "\"x\"",
        "[]",
        "[[]]",
        "[1, 2, 3]",
        "{}",
        "{ number = 1 }",
        "[{ number = 1 }, { number = 1 }]",
        "07:32:00",
        "'''a\nb'''",
        "",
    ];
    let mut random = Random(2);
    let mut accepted = 0;
    for _ in 0..3000 {
        let mut lines: Vec<String> =
            DEFAULT_CELL_TOML.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect();
        for _ in 0..=random.below(3) {
            let (at, other) = (random.below(lines.len()), random.below(lines.len()));
            match (random.below(4), lines[at].split_once(" = ")) {
                (0, _) => drop(lines.remove(at)),
                (1, _) => lines[at] = lines[other].clone(),
                (_, Some((key, _))) => lines[at] = format!("{key} = {}", values[random.below(values.len())]),
                (_, None) => lines[at] = lines[at].replacen(['[', ']'], "", 1),
            }
        }
        accepted += usize::from(check(&lines.join("\n")));
    }
    assert!((100..2900).contains(&accepted), "{accepted}");
}
