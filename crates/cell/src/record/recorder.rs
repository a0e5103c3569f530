//! From the cycle to the file: a bounded ring without locks, and a thread that writes and counts.

use std::io::{self, Write};
use std::path::Path;
use std::sync::mpsc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rtrb::{Consumer, Producer, RingBuffer};
use seamline::kinematics::JointKind;

use super::atomic::AtomicFile;
use super::csv;
use super::figures::{Analysis, Findings};
use super::info::{Event, RunInfo, SegmentInfo};
use super::sample::{MAX_JOINTS, Sample};

/// Samples the ring holds: half a minute at 1 kHz, should the disk pause.
const RING: usize = 1 << 15;
/// Samples taken from the ring at once.
const CHUNK: usize = 1 << 10;
/// Text collected before it goes to the file.
const BUFFER: usize = 1 << 18;
/// How long either side waits for the other before it looks again.
const PAUSE: Duration = Duration::from_micros(200);

/// The cycle's end of the recorder.
#[derive(Debug)]
pub struct SampleSender {
    ring: Producer<Sample>,
    lost: u64,
}

impl SampleSender {
    /// Hands over a sample without waiting, allocating or locking. Where the ring is full the sample is lost, and
    /// counted.
    pub fn push(&mut self, sample: Sample) {
        if self.ring.push(sample).is_err() {
            self.lost += 1;
        }
    }

    /// Hands over a sample; where the ring is full, waits until half of it is free: for runs in logical time, which
    /// nobody waits for. Few long waits disturb the cycle's caches less than many short ones.
    pub fn push_waiting(&mut self, sample: Sample) {
        if self.ring.is_full() {
            // The ring is drained, or abandoned by its thread: either ends the wait.
            while self.ring.slots() < RING / 2 && !self.ring.is_abandoned() {
                thread::sleep(PAUSE);
            }
        }
        self.push(sample);
    }

    /// Samples lost so far.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

/// What reaches the thread beside the samples.
#[derive(Debug)]
enum News {
    Segment(Box<SegmentInfo>),
    Event(Event),
}

/// Records one run. Dropped before [`Recorder::finish`], it leaves no file.
#[derive(Debug)]
pub struct Recorder {
    news: mpsc::Sender<News>,
    whole: mpsc::Sender<()>,
    thread: JoinHandle<io::Result<Findings>>,
}

impl Recorder {
    /// Starts the thread that writes `path` and analyses the run.
    ///
    /// # Errors
    /// The file cannot be created, the thread cannot be started, or the robot has more than [`MAX_JOINTS`] joints.
    pub fn start(path: &Path, run: &RunInfo) -> io::Result<(SampleSender, Self)> {
        let joints = run.joints.len();
        if joints == 0 || joints > MAX_JOINTS {
            let text = format!("a recording holds 1 to {MAX_JOINTS} joints, this robot has {joints}");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, text));
        }
        let (producer, ring) = RingBuffer::new(RING);
        let (news, news_receiver) = mpsc::channel();
        let (whole, whole_receiver) = mpsc::channel();
        let writer = Writer {
            ring,
            news: news_receiver,
            whole: whole_receiver,
            analysis: Analysis::new(run),
            file: AtomicFile::create(path)?,
            joints: run.joints.iter().map(|joint| joint.kind).collect(),
        };
        let thread = thread::Builder::new().name("recorder".to_owned()).spawn(move || writer.run())?;
        Ok((SampleSender { ring: producer, lost: 0 }, Self { news, whole, thread }))
    }

    /// Announces a segment, at the latest before the cycle pushes its first sample.
    pub fn segment(&self, segment: SegmentInfo) {
        self.tell(News::Segment(Box::new(segment)));
    }

    /// Reports an event, at the latest before the cycle pushes the first sample after its time.
    pub fn event(&self, event: Event) {
        self.tell(News::Event(event));
    }

    fn tell(&self, news: News) {
        // A thread that has ended has an error to show, and `finish` shows it.
        let _ = self.news.send(news);
    }

    /// Waits until all is written, gives the file its name and returns what was found.
    ///
    /// # Errors
    /// Whatever kept the file from being written; then there is no file.
    pub fn finish(self, samples: SampleSender) -> io::Result<Findings> {
        // As above: its error comes from the join.
        let _ = self.whole.send(());
        drop(samples);
        self.thread.join().unwrap_or_else(|_| Err(io::Error::other("the recorder's thread panicked")))
    }
}

/// The thread's side.
#[derive(Debug)]
struct Writer {
    ring: Consumer<Sample>,
    news: mpsc::Receiver<News>,
    /// Says that the run was ended properly; silent where the recorder was dropped instead.
    whole: mpsc::Receiver<()>,
    analysis: Analysis,
    file: AtomicFile,
    joints: Vec<JointKind>,
}

impl Writer {
    fn run(mut self) -> io::Result<Findings> {
        let mut text = Vec::with_capacity(BUFFER + (1 << 12));
        text.extend_from_slice(csv::header(&self.joints).as_bytes());
        text.push(b'\n');
        loop {
            // Asked before the ring is looked at, so that no sample slips through between the two.
            let ended = self.ring.is_abandoned();
            let available = self.ring.slots().min(CHUNK);
            // News of these samples was sent before them, so that it is here.
            while let Ok(news) = self.news.try_recv() {
                match news {
                    News::Segment(segment) => self.analysis.segment(*segment),
                    News::Event(event) => self.analysis.event(event),
                }
            }
            if available == 0 {
                if ended {
                    break;
                }
                thread::sleep(PAUSE);
                continue;
            }
            if let Ok(chunk) = self.ring.read_chunk(available) {
                for sample in chunk {
                    csv::push_row(&mut text, &sample, self.joints.len());
                    self.analysis.sample(&sample);
                    if text.len() >= BUFFER {
                        self.file.write_all(&text)?;
                        text.clear();
                    }
                }
            }
        }
        self.file.write_all(&text)?;
        if self.whole.try_recv().is_err() {
            return Err(io::Error::other("the run was abandoned"));
        }
        self.file.commit()?;
        Ok(self.analysis.finish())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::testing::{Folder, Random, robot};
    use seamline::control::Mode;

    use crate::record::{Recording, RecordingError};
    use seamline::geometry::{Pose, Rotation, Vector3};

    /// Any sample: numbers of all sizes, all modes.
    fn sample(random: &mut Random, cycle: u32, joints: usize) -> Sample {
        let mut sample = Sample::at_rest();
        sample.time = f64::from(cycle) * 1e-3;
        sample.mode = Mode::ALL[cycle as usize % Mode::ALL.len()];
        sample.line = cycle % 1013;
        sample.segment = (random.bits() >> 32) as u32;
        sample.override_rate = random.within(0.0, 1.0);
        for joint in 0..joints {
            sample.command[joint] = random.within(-3.0, 3.0);
            sample.measured[joint] = random.within(-3.0, 3.0) * 1e-7;
        }
        let mut vector =
            || Vector3::new(random.within(-2.0, 2.0), random.within(-2.0, 2.0), random.within(-2.0, 2.0));
        sample.tcp = Pose::from_parts(vector().into(), Rotation::from_scaled_axis(vector()));
        sample.tcp_speed = random.within(0.0, 1.0);
        sample.arc = cycle.is_multiple_of(3);
        sample.seam_lateral = random.within(-1e-3, 1e-3);
        if cycle.is_multiple_of(2) {
            sample.seam_error = random.within(-1e-5, 1e-5);
        }
        sample
    }

    /// NaN differs from itself; as text it does not.
    fn same(a: &Sample, b: &Sample) -> bool {
        format!("{a:?}") == format!("{b:?}")
    }

    /// 5,000 random samples of robots of 1 to 7 joints come back bit for bit.
    #[test]
    fn recordings_come_back_bit_for_bit() {
        let folder = Folder::new("round-trip");
        let path = folder.file("recording.csv");
        let mut random = Random::new(11);
        for joints in [1, 4, 6, 7] {
            let run = robot(joints);
            let (mut sender, recorder) = Recorder::start(&path, &run).unwrap();
            let samples: Vec<_> = (0..5000).map(|cycle| sample(&mut random, cycle, joints)).collect();
            for sample in &samples {
                sender.push_waiting(*sample);
            }
            let findings = recorder.finish(sender).unwrap();
            assert_eq!(findings.cycles, 5000);
            let read = Recording::read(&path).unwrap();
            assert!(read.joints.iter().eq(run.joints.iter().map(|joint| &joint.kind)));
            assert_eq!(read.samples.len(), samples.len());
            assert!(read.samples.iter().zip(&samples).all(|(read, written)| same(read, written)));
        }
        assert_eq!(folder.names(), ["recording.csv"]);
    }

    /// A full ring loses samples and counts them; what arrived is recorded.
    #[test]
    fn lost_samples_are_counted() {
        let folder = Folder::new("lost");
        let path = folder.file("recording.csv");
        let (mut sender, recorder) = Recorder::start(&path, &robot(6)).unwrap();
        let pushed = 4 * RING as u64;
        for _ in 0..pushed {
            sender.push(Sample::at_rest());
        }
        let lost = sender.lost();
        assert_eq!(recorder.finish(sender).unwrap().cycles + lost, pushed);
        assert_eq!(Recording::read(&path).unwrap().samples.len() as u64 + lost, pushed);
    }

    /// An abandoned run leaves the recording of the run before it, and nothing else.
    #[test]
    fn an_abandoned_run_leaves_no_file() {
        let folder = Folder::new("abandoned");
        let path = folder.file("recording.csv");
        std::fs::write(&path, "the run before").unwrap();
        let (mut sender, recorder) = Recorder::start(&path, &robot(6)).unwrap();
        sender.push(Sample::at_rest());
        let Recorder { thread, news, whole } = recorder;
        drop((sender, news, whole));
        assert!(thread.join().unwrap().is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"the run before");
        assert_eq!(folder.names(), ["recording.csv"]);
    }

    #[test]
    fn wrong_robots_folders_and_files_are_refused() {
        let folder = Folder::new("refused");
        let path = folder.file("recording.csv");
        for joints in [0, MAX_JOINTS + 1] {
            assert!(Recorder::start(&path, &robot(joints)).is_err());
        }
        let error = Recorder::start(&folder.file("no/such/recording.csv"), &robot(6)).unwrap_err();
        assert!(error.to_string().contains("recording.csv"), "{error}");
        let header = csv::header(&[JointKind::Revolute]);
        let row = "0.0,running,1,1,1.0,0.1,0.1,1.0,2.0,3.0,0.0,0.0,0.0,1.0,5.0,1,0.0,0.0,";
        for (content, message) in [
            (String::new(), "line 1: this is not the header of a recording"),
            ("time_s,mode\n".to_owned(), "line 1: this is not the header of a recording"),
            (
                format!("{header}\n{row}\n{}\n", row.replace("running", "dancing")),
                "line 3, column 2 (mode): missing or not readable",
            ),
            (format!("{header}\n0.0,running\n"), "line 2, column 3 (line): missing or not readable"),
            (format!("{header}\n{row},7\n"), "line 2, column 20: one cell too many"),
            (
                format!("{header}\n{}\n", row.replace("2.0", "2,0")),
                "line 2, column 16 (arc): missing or not readable",
            ),
        ] {
            std::fs::write(&path, content).unwrap();
            assert_eq!(Recording::read(&path).unwrap_err().to_string(), message);
        }
        std::fs::write(&path, format!("{header}\n{row}\n")).unwrap();
        assert_eq!(Recording::read(&path).unwrap().samples[0].tcp.translation.vector.y, 2e-3);
        assert!(matches!(Recording::read(&folder.file("none")), Err(RecordingError::Io(_))));
    }
}
