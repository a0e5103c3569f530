//! JSON lines: one question a line on the input, one answer a line on the output, in order.
//!
//! | module | holds |
//! |---|---|
//! | `stream` | the loop from input to output |
//! | `object` | reading of an object's members, with the member's place in every message |
//! | `bench` | the same questions, read first and then measured |

pub(crate) mod bench;
mod object;
mod stream;

pub(crate) use object::{Mistake, Numbers, Object};
pub(crate) use stream::{answer_each, print_line, questions};
