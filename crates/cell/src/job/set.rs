//! The jobs of one run: the entry job and every job that it may come to.

use std::sync::Arc;

use super::program::Job;

/// Jobs that call each other by name, all references resolved.
#[derive(Debug, Clone)]
pub struct JobSet {
    jobs: Vec<Arc<Job>>,
}

impl JobSet {
    /// The jobs, the entry job first.
    pub fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.jobs.iter().map(AsRef::as_ref)
    }
}
