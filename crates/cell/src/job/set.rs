//! The jobs of one run: the entry job and every job that it may come to.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::error::{JobError, JobErrors, LoadError, Mistake};
use super::instruction::{Flow, Instruction, JobReference, JumpTarget};
use super::names::nearest;
use super::program::{Job, JobFile};

/// Jobs that call each other by name, all references resolved.
#[derive(Debug, Clone)]
pub struct JobSet {
    /// The entry job first.
    jobs: Vec<Arc<Job>>,
    index: BTreeMap<Arc<str>, usize>,
}

impl JobSet {
    /// Reads a job file and, from the same folder, every job that it calls or jumps to; the first job of the file
    /// is the entry.
    ///
    /// Jobs are found by their `//NAME` in files that end in `.JBI`, in either case.
    ///
    /// # Errors
    /// Where a file cannot be read, or any of the jobs is wrong: all mistakes of all of them.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        let mut files = vec![read(path)?];
        let mut shelf: Option<BTreeMap<String, PathBuf>> = None;
        // Ends: every turn reads a file that was not read yet, and the folder has so many.
        while let Some(name) = missing_name(&files) {
            if shelf.is_none() {
                shelf = Some(names_in_folder(path)?);
            }
            let Some(found) = shelf.as_mut().and_then(|shelf| shelf.remove(&name)) else { break };
            files.push(read(&found)?);
        }
        let known: Vec<String> = shelf.into_iter().flat_map(BTreeMap::into_keys).collect();
        Ok(Self::resolve(files, &known)?)
    }

    /// A set of files that are in memory already; the first job of the first file is the entry.
    ///
    /// # Errors
    /// Where a job refers to one that is not among them, or two have the same name.
    pub fn from_files(files: Vec<JobFile>) -> Result<Self, JobErrors> {
        Self::resolve(files, &[])
    }

    /// The jobs, the entry job first.
    pub fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.jobs.iter().map(AsRef::as_ref)
    }

    /// The job where a run begins.
    #[must_use]
    pub fn entry(&self) -> &Job {
        // A file holds at least one job, and a set at least one file.
        &self.jobs[0]
    }

    /// The job at a position in the set.
    pub(super) fn at(&self, index: usize) -> Option<&Arc<Job>> {
        self.jobs.get(index)
    }

    /// The position of a job in the set.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    fn resolve(files: Vec<JobFile>, also_known: &[String]) -> Result<Self, JobErrors> {
        let jobs: Vec<Arc<Job>> = files.into_iter().flat_map(|file| file.jobs).map(Arc::new).collect();
        let mut errors = Vec::new();
        let mut index = BTreeMap::new();
        for (i, job) in jobs.iter().enumerate() {
            if let Some(first) = index.insert(Arc::clone(&job.name), i) {
                let first = jobs.get(first).map_or(0, |job| job.line);
                let mistake = Mistake::Duplicate { what: "job", name: job.name.to_string(), first };
                errors.push(job.error(job.line, 1, mistake));
            }
        }
        for job in &jobs {
            for (line, reference) in references(job) {
                if !index.contains_key(reference.name.as_str()) {
                    let known = index.keys().map(AsRef::as_ref).chain(also_known.iter().map(String::as_str));
                    let nearest = nearest(&reference.name, known);
                    let mistake = Mistake::Unknown { what: "job", name: reference.name.clone(), nearest };
                    errors.push(job.error(line, reference.column, mistake));
                }
            }
        }
        if jobs.is_empty() {
            let file = Arc::from("");
            errors.push(JobError { file, line: 1, column: 1, mistake: Mistake::NoJob });
        }
        JobErrors::check(errors)?;
        Ok(Self { jobs, index })
    }
}

/// The jobs that a job refers to, with the line.
fn references(job: &Job) -> impl Iterator<Item = (u32, &JobReference)> {
    job.program.iter().filter_map(|statement| match &statement.instruction {
        Instruction::Flow(Flow::Call { target, .. } | Flow::Jump { target: JumpTarget::Job(target), .. }) => {
            Some((statement.line, target))
        }
        _ => None,
    })
}

/// A job that is referred to and not read yet.
fn missing_name(files: &[JobFile]) -> Option<String> {
    let jobs = || files.iter().flat_map(|file| &file.jobs);
    jobs()
        .flat_map(references)
        .map(|(_, reference)| &reference.name)
        .find(|name| !jobs().any(|job| *job.name == ***name))
        .cloned()
}

fn read(path: &Path) -> Result<JobFile, LoadError> {
    let bytes = fs::read(path).map_err(|reason| unreadable(path, reason))?;
    Ok(JobFile::parse(&path.display().to_string(), &bytes)?)
}

fn unreadable(path: &Path, reason: std::io::Error) -> LoadError {
    LoadError::Read { path: path.display().to_string(), reason }
}

/// Names of all jobs in the folder of a file, and the files that hold them.
fn names_in_folder(path: &Path) -> Result<BTreeMap<String, PathBuf>, LoadError> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut names = BTreeMap::new();
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .map_err(|reason| unreadable(folder, reason))?
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|p| p.extension().is_some_and(|e| e.eq_ignore_ascii_case("jbi")))
        .collect();
    // The same file wins on every machine, whatever order the folder lists them in.
    paths.sort();
    for file in paths {
        let Ok(bytes) = fs::read(&file) else { continue };
        for line in bytes.split(|b| *b == b'\n') {
            if let Some(name) = line.trim_ascii().strip_prefix(b"//NAME ") {
                let name = super::lexer::printable(name.trim_ascii());
                names.entry(name).or_insert_with(|| file.clone());
            }
        }
    }
    Ok(names)
}
