//! INFORM jobs from outside: what is read, what is refused, what runs.

mod forms;
mod mistakes;
mod mutation;
mod run;
mod samples;
mod support;
