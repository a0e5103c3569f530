//! The paper's state chart (its figures 2 and 4) as one explicit table.

/// What the axes are doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Activity {
    /// At rest in the first position: no target has come yet.
    Start,
    /// On the way to the last target.
    Moving,
    /// At rest in the last target.
    Holding,
}

/// What can happen to them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// A new target has come, and there is a plan that leads to it.
    NewTarget,
    /// The plan has come to its end.
    Arrived,
}

impl Activity {
    /// All activities, for tables.
    pub const ALL: [Self; 3] = [Self::Start, Self::Moving, Self::Holding];

    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Moving => "moving",
            Self::Holding => "holding",
        }
    }

    /// The activity after an event, or `None` where the event means nothing: who rests cannot arrive.
    ///
    /// A target that comes in motion does not wait for the arrival: the new plan begins at once, where the axes are.
    #[must_use]
    pub fn after(self, event: Event) -> Option<Self> {
        match (self, event) {
            (Self::Start | Self::Moving | Self::Holding, Event::NewTarget) => Some(Self::Moving),
            (Self::Moving, Event::Arrived) => Some(Self::Holding),
            (Self::Start | Self::Holding, Event::Arrived) => None,
        }
    }
}

impl Event {
    /// All events, for tables.
    pub const ALL: [Self; 2] = [Self::NewTarget, Self::Arrived];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_activity_and_event() {
        let mut table = std::string::String::new();
        for activity in Activity::ALL {
            for event in Event::ALL {
                let next = activity.after(event).map_or("-", Activity::name);
                table += &std::format!("{} {event:?} -> {next}\n", activity.name());
            }
        }
        let expected = "\
start NewTarget -> moving
start Arrived -> -
moving NewTarget -> moving
moving Arrived -> holding
holding NewTarget -> moving
holding Arrived -> -
";
        assert_eq!(table, expected);
    }
}
