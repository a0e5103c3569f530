//! 9 × (4,000 + 1,500 + 500 + 500) problems: never an error, never invalid, never longer than the peers.

use seamline::otg::Control;
use seamline_peers::compare::compare;
use seamline_peers::otg_support::cases::ALL;

#[test]
fn never_longer_than_the_peers() {
    for distribution in ALL {
        for tally in [
            compare::<1>(distribution, Control::Position, 1, 4_000),
            compare::<3>(distribution, Control::Position, 2, 1_500),
            compare::<6>(distribution, Control::Position, 3, 500),
            compare::<3>(distribution, Control::Velocity, 4, 500),
        ] {
            assert!(tally.is_good(), "{distribution:?}: {tally:?}");
        }
    }
}
