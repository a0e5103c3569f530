//! Arc and weave.

use super::super::expression::Expression;
use super::super::instruction::{ArcTags, Instruction, WeaveTags, Weld};
use super::super::lexer::{Fault, Lexer, TokenKind, printable};
use super::{io, operand};

type Parsed<T> = Result<T, Fault>;

/// The instruction that begins with this word, if it is one of these.
pub(super) fn instruction(lexer: &mut Lexer<'_>, word: &str) -> Parsed<Option<Instruction>> {
    let weld = match word {
        "ARCON" => Weld::ArcOn(Box::new(arc_tags(lexer, "ASF")?)),
        "ARCOF" => Weld::ArcOff(Box::new(arc_tags(lexer, "AEF")?)),
        "ARCSET" => Weld::ArcSet(Box::new(arc_tags(lexer, "ASF")?)),
        "WVON" => Weld::WeaveOn(Box::new(weave_tags(lexer)?)),
        "WVOF" => {
            lexer.rest();
            Weld::WeaveOff
        }
        "COMARCON" => Weld::TrackOn(track_tags(lexer)),
        "COMARCOF" => {
            lexer.rest();
            Weld::TrackOff
        }
        "MEMON" => memory_on(lexer)?,
        "MEMOF" => {
            lexer.rest();
            Weld::MemoryOff
        }
        _ => return Ok(None),
    };
    Ok(Some(Instruction::Weld(weld)))
}

fn arc_tags(lexer: &mut Lexer<'_>, file: &str) -> Parsed<ArcTags> {
    let mut tags = ArcTags::default();
    loop {
        let word = match lexer.peek().kind {
            TokenKind::End => return Ok(tags),
            TokenKind::Word(word) => word,
            _ => return Err(lexer.unexpected("a tag such as AC= or ASF#(n)")),
        };
        let number = word.strip_prefix("WELD").and_then(|n| n.parse::<u32>().ok());
        match word {
            _ if word == file => {
                lexer.next();
                let number = operand::hash_expression(lexer)?;
                operand::check_range(&number, "the condition's number", 1.0, 1000.0)?;
                tags.file = Some(number);
            }
            "AC" => tags.current = Some(tag(lexer, "AC (A)", 1.0, 999.0)?),
            "AV" => tags.voltage = Some(tag(lexer, "AV (V)", 0.1, 50.0)?),
            "AVP" => tags.voltage_percent = Some(tag(lexer, "AVP (%)", 50.0, 150.0)?),
            "V" => tags.speed = Some(tag(lexer, "V", 0.01, 10_000.0)?),
            "T" => {
                lexer.next();
                tags.time = Some(io::time(lexer)?);
            }
            _ if number.is_some() => {
                lexer.next();
                tags.power_source = number;
            }
            _ => keep(lexer, &mut tags.other_tags),
        }
    }
}

fn weave_tags(lexer: &mut Lexer<'_>) -> Parsed<WeaveTags> {
    let mut tags = WeaveTags::default();
    loop {
        match lexer.peek().kind {
            TokenKind::End => return Ok(tags),
            TokenKind::Word("WEV") => {
                lexer.next();
                let number = operand::hash_expression(lexer)?;
                operand::check_range(&number, "the condition's number", 1.0, 255.0)?;
                tags.file = Some(number);
            }
            TokenKind::Word("AMP") => tags.amplitude = Some(tag(lexer, "AMP (mm)", 0.1, 99.9)?),
            TokenKind::Word("FREQ") => tags.frequency = Some(tag(lexer, "FREQ (Hz)", 0.1, 50.0)?),
            TokenKind::Word("ANGL") => tags.angle = Some(tag(lexer, "ANGL (deg)", 0.0, 180.0)?),
            TokenKind::Word("DIR") => tags.direction = Some(tag(lexer, "DIR", 0.0, 1.0)?),
            TokenKind::Word(_) => keep(lexer, &mut tags.other_tags),
            _ => return Err(lexer.unexpected("a tag such as AMP= or WEV#(n)")),
        }
    }
}

/// All that stands in the line.
fn track_tags(lexer: &mut Lexer<'_>) -> Vec<String> {
    let rest = lexer.rest();
    printable(rest).split_whitespace().map(str::to_owned).collect()
}

fn memory_on(lexer: &mut Lexer<'_>) -> Parsed<Weld> {
    let record = match lexer.peek().kind {
        TokenKind::Word("REC") => true,
        TokenKind::Word("PLY") => false,
        _ => return Err(lexer.unexpected("REC or PLY")),
    };
    lexer.next();
    if lexer.peek().kind != TokenKind::Word("MPF") {
        return Err(lexer.unexpected("MPF#(n)"));
    }
    lexer.next();
    let file = operand::hash_expression(lexer)?;
    operand::check_range(&file, "the file's number", 1.0, 9999.0)?;
    Ok(Weld::MemoryOn { record, file: Box::new(file) })
}

fn tag(lexer: &mut Lexer<'_>, what: &'static str, min: f64, max: f64) -> Parsed<Expression> {
    lexer.next();
    let value = operand::tag_value(lexer)?;
    operand::check_range(&value, what, min, max)?;
    Ok(value)
}

fn keep(lexer: &mut Lexer<'_>, tags: &mut Vec<String>) {
    if let TokenKind::Text(tag) = lexer.name().kind {
        tags.push(printable(tag));
    }
}
