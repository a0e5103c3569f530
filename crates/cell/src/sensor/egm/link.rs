//! The thread between the socket and the cycle.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as Clock, SystemTime, UNIX_EPOCH};

use prost::Message;
use rtrb::{Consumer, Producer, RingBuffer};
use seamline::seam::{Instant, Reading, SeamSensor, Sensor, TaughtPath};

use super::gate::{Correction, DropReason, EgmGate, LENGTH_MAX};
use super::messages;

/// Corrections that wait for the cycle: a quarter of a second at 250 Hz.
const CORRECTIONS: usize = 64;
/// States of the torch that wait for the thread.
const STATES: usize = 256;
/// Time between two messages to the client: EGM's own.
const FEEDBACK: Duration = Duration::from_millis(4);

/// Where the client is, and what is believed of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EgmSettings {
    /// The address that the controller binds: one of the loopback unless the cell says otherwise. Port 0 is any.
    pub listen: SocketAddr,
    /// The client's address. What comes from elsewhere is dropped.
    pub client: SocketAddr,
    /// Greatest age of a measurement, in seconds.
    pub age_max: f64,
}

/// How many datagrams were accepted, and why others were not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EgmCounts {
    /// Handed to the cycle.
    pub accepted: u64,
    dropped: [u64; DropReason::ALL.len()],
}

impl EgmCounts {
    /// Datagrams dropped for a reason.
    #[must_use]
    pub fn of(&self, reason: DropReason) -> u64 {
        self.dropped[reason as usize]
    }

    /// Datagrams dropped for any reason.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.iter().sum()
    }
}

/// What thread and cycle share.
#[derive(Debug, Default)]
struct Shared {
    accepted: AtomicU64,
    dropped: [AtomicU64; DropReason::ALL.len()],
    ended: AtomicBool,
}

impl Shared {
    fn count(&self, reason: DropReason) {
        self.dropped[reason as usize].fetch_add(1, Ordering::Relaxed);
    }
}

/// A client that sends EGM path corrections. A thread of its own speaks with it; the cycle never waits.
#[derive(Debug)]
pub struct EgmSensor {
    corrections: Consumer<(Correction, Clock)>,
    states: Producer<Instant>,
    /// Time of the cycle whose state was told last.
    told: f64,
    age_max: f64,
    shared: Arc<Shared>,
    address: SocketAddr,
    thread: Option<JoinHandle<()>>,
}

impl EgmSensor {
    /// Binds the socket and starts the thread. From the first poll on the client is told every 4 ms where the torch is.
    ///
    /// # Errors
    /// The address cannot be bound, or the thread cannot be started.
    pub fn open(settings: &EgmSettings) -> io::Result<Self> {
        let named =
            |error: io::Error| io::Error::new(error.kind(), format!("EGM at {}: {error}", settings.listen));
        let socket = UdpSocket::bind(settings.listen).map_err(named)?;
        // Feedback goes out on time only if waiting for datagrams ends.
        socket.set_read_timeout(Some(FEEDBACK / 4)).map_err(named)?;
        let address = socket.local_addr().map_err(named)?;
        let (to_cycle, corrections) = RingBuffer::new(CORRECTIONS);
        let (states, from_cycle) = RingBuffer::new(STATES);
        let shared = Arc::new(Shared::default());
        let link = Link {
            socket,
            client: settings.client,
            gate: EgmGate::new(settings.age_max),
            corrections: to_cycle,
            states: from_cycle,
            torch: None,
            sent: 0,
            shared: Arc::clone(&shared),
        };
        let thread = thread::Builder::new().name("egm".to_owned()).spawn(move || link.run())?;
        let age_max = settings.age_max;
        Ok(Self {
            corrections,
            states,
            told: f64::NEG_INFINITY,
            age_max,
            shared,
            address,
            thread: Some(thread),
        })
    }

    /// The address that is bound.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Corrections that have come and wait for the cycle.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.corrections.slots()
    }

    /// What became of the datagrams so far.
    #[must_use]
    pub fn counts(&self) -> EgmCounts {
        let of = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        EgmCounts { accepted: of(&self.shared.accepted), dropped: self.shared.dropped.each_ref().map(of) }
    }
}

impl SeamSensor for EgmSensor {
    /// Exposure is the cycle's time, less the age that the client states, less what passed since the datagram came.
    fn poll(&mut self, torch: &Instant, _: &Sensor, _: &impl TaughtPath) -> Option<Reading> {
        if torch.time != self.told {
            self.told = torch.time;
            // A thread that is behind gets a later state.
            let _ = self.states.push(*torch);
        }
        // As many as the ring holds at most.
        while let Ok((correction, received)) = self.corrections.pop() {
            let age = correction.age + received.elapsed().as_secs_f64();
            if age > self.age_max {
                self.shared.count(DropReason::Stale);
                continue;
            }
            self.shared.accepted.fetch_add(1, Ordering::Relaxed);
            let Correction { lateral, height, .. } = correction;
            return Some(Reading { lateral, height, gap: None, exposure: torch.time - age, quality: 1.0 });
        }
        None
    }
}

impl std::ops::Drop for EgmSensor {
    fn drop(&mut self) {
        self.shared.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // It has nothing to report.
            let _ = thread.join();
        }
    }
}

/// The thread's side.
#[derive(Debug)]
struct Link {
    socket: UdpSocket,
    client: SocketAddr,
    gate: EgmGate,
    corrections: Producer<(Correction, Clock)>,
    states: Consumer<Instant>,
    torch: Option<Instant>,
    /// Messages sent.
    sent: u32,
    shared: Arc<Shared>,
}

impl Link {
    /// Until the cycle's side is dropped.
    fn run(mut self) {
        let start = Clock::now();
        let mut due = start;
        // One byte more than is accepted: a longer datagram is cut, and must be told from one that just fits.
        let mut buffer = [0; LENGTH_MAX + 1];
        while !self.shared.ended.load(Ordering::Relaxed) {
            match self.socket.recv_from(&mut buffer) {
                Ok((length, from)) => self.take(&buffer[..length], from, start),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                // A client that is not there yet makes the socket complain of each message to it: without a pause that would spin.
                Err(_) => thread::sleep(FEEDBACK / 4),
            }
            while let Ok(torch) = self.states.pop() {
                self.torch = Some(torch);
            }
            if Clock::now() >= due {
                due = Clock::now() + FEEDBACK;
                self.tell();
            }
        }
    }

    fn take(&mut self, datagram: &[u8], from: SocketAddr, start: Clock) {
        let received = Clock::now();
        let judged = if from == self.client {
            self.gate.judge(datagram, (received - start).as_secs_f64())
        } else {
            Err(DropReason::Foreign)
        };
        let handed_over = judged.and_then(|correction| {
            self.corrections.push((correction, received)).map_err(|_| DropReason::RingFull)
        });
        if let Err(reason) = handed_over {
            self.shared.count(reason);
        }
    }

    /// Tells the client where the torch is.
    fn tell(&mut self) {
        let Some(torch) = self.torch else { return };
        self.sent = self.sent.wrapping_add(1);
        let message = feedback(&torch, self.sent).encode_to_vec();
        // A client that is not there yet will be told the next time.
        let _ = self.socket.send_to(&message, self.client);
    }
}

fn feedback(torch: &Instant, number: u32) -> messages::Robot {
    let position = torch.base_from_tcp.translation.vector * 1e3;
    let turn = torch.base_from_tcp.rotation.quaternion();
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    // EGM's time stamp is a count of milliseconds that begins again after 49 days.
    let tm = (torch.time * 1e3) as u64 as u32;
    messages::Robot {
        header: Some(messages::Header { seqno: Some(number), tm: Some(tm), mtype: Some(messages::DATA) }),
        feed_back: Some(messages::FeedBack {
            cartesian: Some(messages::PoseMessage {
                pos: Some(messages::Cartesian {
                    x: Some(position.x),
                    y: Some(position.y),
                    z: Some(position.z),
                }),
                orient: Some(messages::Quaternion {
                    u0: Some(turn.w),
                    u1: Some(turn.i),
                    u2: Some(turn.j),
                    u3: Some(turn.k),
                }),
            }),
            time: Some(messages::Clock {
                sec: Some(now.as_secs()),
                usec: Some(u64::from(now.subsec_micros())),
            }),
        }),
        mci_state: Some(messages::MciState { state: Some(messages::RUNNING) }),
    }
}
