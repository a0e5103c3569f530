//! Aids of this folder's tests.

use std::path::PathBuf;

use seamline::kinematics::JointKind;

use super::info::{Acceptance, JointInfo, RunInfo};

/// A small generator of pseudo-random numbers (splitmix64), so that every run sees the same cases.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A folder of its own for a test, gone when the test is over.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("seamline-record-{}-{test}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(super) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder left behind harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A robot with limits that differ from joint to joint.
pub(super) fn robot(joints: usize) -> RunInfo {
    let joint = |index: usize| {
        let scale = 1.0 + index as f64;
        JointInfo {
            name: format!("J{}", index + 1),
            // The third joint slides, as a SCARA's.
            kind: if index == 2 { JointKind::Prismatic } else { JointKind::Revolute },
            position: [-scale, 2.0 * scale],
            velocity: 2.0 * scale,
            acceleration: 10.0 * scale,
            jerk: 500.0 * scale,
        }
    };
    RunInfo {
        job: "TEST".to_owned(),
        robot: "bench".to_owned(),
        joints: (0..joints).map(joint).collect(),
        period: 1e-3,
        acceptance: Acceptance::default(),
    }
}
