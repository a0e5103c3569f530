//! Mistakes in cell files, each with its one message.

use super::*;

/// What is written, and the whole message.
const MISTAKES: &[(&str, &str)] = &[
    ("[robot", "cell.toml:1:7: not TOML: unclosed table, expected `]`"),
    (
        "[cycle]\nperiod_ms = \n",
        "cell.toml:2:13: not TOML: string values must be quoted, expected literal string",
    ),
    ("[cycle]\nperiod_ms = 1.0\nperiod_ms = 2.0\n", "cell.toml:3:1: not TOML: duplicate key"),
    (
        "[cycle]\nperiod_ms = 1,0\n",
        "cell.toml:2:14: not TOML: unexpected key or value, expected newline, `#`",
    ),
    (
        "[job]\nspeed_unit = mm/s\n",
        "cell.toml:2:14: not TOML: string values must be quoted, expected literal string",
    ),
    ("[job]\nspeed_unit = \"mm/s\n", "cell.toml:2:19: not TOML: invalid basic string, expected `\"`"),
    ("[cycle]\n[cycle]\n", "cell.toml:2:2: not TOML: duplicate key"),
    ("[robott]\nname = \"x\"\n", "cell.toml:1:2: robott: unknown key, did you mean robot?"),
    (
        "colour = \"red\"\n",
        "cell.toml:1:1: colour: unknown key, expected one of robot, cartesian, tool, user_frame, job, arc_start, arc_end, weave, pass, arc, sensor, flexible_mode, vibration, io, cycle, safety, drive, simulation",
    ),
    ("robot = 5\n", "cell.toml:1:9: robot: found 5, expected a table"),
    ("[[robot]]\nname = \"x\"\n", "cell.toml:1:1: robot: found [[robot]], expected a table"),
    ("[tool]\nnumber = 1\n", "cell.toml:1:1: tool: found [tool], expected tables, each headed by [[tool]]"),
    ("tool = \"torch\"\n", "cell.toml:1:8: tool: found \"torch\", expected tables, each headed by [[tool]]"),
    ("tool = [1, 2]\n", "cell.toml:1:8: tool: found [1, 2], expected tables, each headed by [[tool]]"),
    (
        "[[tool]]\nx_mm = 1.0\n",
        "cell.toml:1:1: tool.number: missing, expected a whole number in each of these tables",
    ),
    (
        "[[tool]]\nnumber = \"0\"\nx_mm = 1.0\n",
        "cell.toml:2:10: tool.number: found \"0\", expected a whole number in each of these tables",
    ),
    (
        "[[tool]]\nnumber = 64\n",
        "cell.toml:2:10: tool[64].number: found 64, expected a whole number from 0 to 63",
    ),
    (
        "[[tool]]\nnumber = -1\n",
        "cell.toml:2:10: tool[-1].number: found -1, expected a whole number from 0 to 63",
    ),
    (
        "[[tool]]\nnumber = 3\n[[tool]]\nnumber = 4\n[[tool]]\nnumber = 3\n",
        "cell.toml:5:1: tool[3]: number given twice, first on line 1",
    ),
    (
        "[[tool]]\nnumber = 5\n",
        "cell.toml:1:1: tool[5].x_mm: missing, expected a number from -100000 to 100000",
    ),
    (
        "[sensor]\nsource = \"lidar\"\n",
        "cell.toml:2:10: sensor.source: found \"lidar\", expected \"none\", \"simulated\", \"replay\" or \"egm\"",
    ),
    (
        "[sensor]\nsource = \"replay\"\n",
        "cell.toml:1:1: sensor.replay_file: missing, expected the recording that is replayed",
    ),
    (
        "[sensor]\negm_client = \"localhost\"\n",
        "cell.toml:2:14: sensor.egm_client: found \"localhost\", expected an address with a port, such as \"127.0.0.1:6510\"",
    ),
    (
        "[[simulation.seam]]\nnumber = 1\nkind = \"wave\"\nat_mm = 0.0\n",
        "cell.toml:3:8: simulation.seam[1].kind: found \"wave\", expected \"sine\", \"drift\", \"step\", \"kink\", \"tack\" or \"gap\"",
    ),
    (
        "[[simulation.seam]]\nnumber = 1\nkind = \"gap\"\nat_mm = 10.0\nlength_mm = 0.0\n",
        "cell.toml:5:13: simulation.seam[1].length_mm: found 0.0, expected a number from 0.1 to 100000",
    ),
    (
        "[[simulation.seam]]\nnumber = 1\nkind = \"kink\"\nat_mm = 10.0\nlateral_deg = 60.0\n",
        "cell.toml:5:15: simulation.seam[1].lateral_deg: found 60.0, expected a number from -45 to 45",
    ),
    (
        "[[simulation.fault]]\nnumber = 1\nkind = \"arc-loss\"\ntime_s = -1\n",
        "cell.toml:4:10: simulation.fault[1].time_s: found -1, expected a number from 0 to 1000000",
    ),
    (
        "[[simulation.fault]]\nnumber = 1\nkind = \"arc-loss\"\ntime_s = 1\njoint = 7\n",
        "cell.toml:5:9: simulation.fault[1].joint: found 7, expected a whole number from 1 to 6",
    ),
    ("[[tool]]\nnumber = 5\nx_m = 0.1\n", "cell.toml:3:1: tool[5].x_m: unknown key, did you mean x_mm?"),
    (
        "[[tool]]\nnumber = 0\nz_mm = \"458\"\n",
        "cell.toml:3:8: tool[0].z_mm: found \"458\", expected a number from -100000 to 100000",
    ),
    (
        "[[tool]]\nnumber = 0\nz_mm = nan\n",
        "cell.toml:3:8: tool[0].z_mm: found nan, expected a number from -100000 to 100000",
    ),
    (
        "[[tool]]\nnumber = 0\nrx_deg = 400\n",
        "cell.toml:3:10: tool[0].rx_deg: found 400, expected a number from -360 to 360",
    ),
    ("[[tool]]\nnumber = 0\nname = 7\n", "cell.toml:3:8: tool[0].name: found 7, expected a text in quotes"),
    (
        "[[user_frame]]\nnumber = 0\n",
        "cell.toml:2:10: user_frame[0].number: found 0, expected a whole number from 1 to 63",
    ),
    (
        "[[user_frame]]\nnumber = 1\nx_mm = 1\ny_mm = 2\n",
        "cell.toml:1:1: user_frame[1].z_mm: missing, expected a number from -100000 to 100000",
    ),
    (
        "[robot]\nmodel = \"ar2011\"\n",
        "cell.toml:2:9: robot.model: found \"ar2011\", expected \"ar2010\", \"irb2400\", \"ur5e\", \"scara600\", \"opw\", \"dh\" or \"urdf\"",
    ),
    (
        "[robot]\nmodel = \"irb2400\"\n",
        "cell.toml:1:1: robot.joint: missing, expected 6 tables [[robot.joint]] (those of the default cell belong to its own robot)",
    ),
    ("[robot]\nmodel = \"opw\"\n", "cell.toml:1:1: robot.opw: missing, expected a table"),
    (
        "[robot]\nmodel = \"opw\"\n[robot.opw]\na1_mm = 150\na2_mm = -200\nb_mm = 0\nc1_mm = 0\nc2_mm = 0\n",
        "cell.toml:8:9: robot.opw.c2_mm: found 0, expected a number from 1 to 10000",
    ),
    (
        "[robot]\nmodel = \"opw\"\n[robot.opw]\na1_mm = 1\na2_mm = 1\nb_mm = 0\nc1_mm = 0\nc2_mm = 7\nc3_mm = 7\nc4_mm = 1\noffsets_deg = [0, 0, 0, 0, 0]\nsigns = [1, 1, 1, 1, 1, 1]\n",
        "cell.toml:11:15: robot.opw.offsets_deg: found [0, 0, 0, 0, 0], expected a list of 6 numbers from -360 to 360",
    ),
    (
        "[robot]\nmodel = \"opw\"\n[robot.opw]\na1_mm = 1\na2_mm = 1\nb_mm = 0\nc1_mm = 0\nc2_mm = 7\nc3_mm = 7\nc4_mm = 1\noffsets_deg = [0, 0, 0, 0, 0, 0]\nsigns = [1, 1, 1, 0, 1, 1]\n",
        "cell.toml:12:9: robot.opw.signs: found [1, 1, 1, 0, 1, 1], expected a list of 6 numbers, each 1 or -1",
    ),
    (
        "[robot]\nmodel = \"dh\"\n[robot.dh]\nconvention = \"craig\"\n",
        "cell.toml:4:14: robot.dh.convention: found \"craig\", expected \"standard\" or \"modified\"",
    ),
    (
        "[robot]\nmodel = \"dh\"\n[robot.dh]\nconvention = \"modified\"\n[[robot.dh.row]]\nnumber = 2\n",
        "cell.toml:6:10: robot.dh.row[2].number: found 2, expected 1: numbers run from 1 without a gap",
    ),
    (
        "[robot]\nmodel = \"urdf\"\n[robot.urdf]\npath = \"\"\n",
        "cell.toml:4:8: robot.urdf.path: found \"\", expected a text in quotes",
    ),
    (
        "[robot.opw]\na1_mm = 150\n",
        "cell.toml:1:1: robot.opw: found [robot.opw], expected model = \"opw\" with this table",
    ),
    (
        "[[robot.joint]]\nnumber = 3\nvelocity_deg_s = -5\n",
        "cell.toml:3:18: robot.joint[3].velocity_deg_s: found -5, expected a number from 0.001 to 100000",
    ),
    (
        "[[robot.joint]]\nnumber = 3\nvelocity_deg_s = inf\n",
        "cell.toml:3:18: robot.joint[3].velocity_deg_s: found inf, expected a number from 0.001 to 100000",
    ),
    (
        "[[robot.joint]]\nnumber = 3\nvelocity_rad_s = 3.8\n",
        "cell.toml:3:1: robot.joint[3].velocity_rad_s: unknown key, did you mean velocity_deg_s?",
    ),
    (
        "[[robot.joint]]\nnumber = 3\nvelocity = 3.8\n",
        "cell.toml:3:1: robot.joint[3].velocity: unknown key, did you mean velocity_deg_s?",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nposition_min_deg = 200\n",
        "cell.toml:3:20: robot.joint[2].position_min_deg: found 200, expected position_min_deg (200) less than position_max_deg (155.0)",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nposition_max_deg = -105\n",
        "cell.toml:3:20: robot.joint[2].position_max_deg: found -105, expected position_min_deg (-105.0) less than position_max_deg (-105)",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nsoft_margin_deg = 130\n",
        "cell.toml:3:19: robot.joint[2].soft_margin_deg: found 130, expected soft_margin_deg (130) less than half the range",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nhome_deg = 154.5\n",
        "cell.toml:3:12: robot.joint[2].home_deg: found 154.5, expected home_deg (154.5) within the soft limits",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nposition_min_deg = 1.0\n",
        "cell.toml:3:20: robot.joint[2].position_min_deg: found 1.0, expected home_deg (0.0) within the soft limits",
    ),
    (
        "[[robot.joint]]\nnumber = 2\npulse_direction = 1\n",
        "cell.toml:3:19: robot.joint[2].pulse_direction: found 1, expected \"positive\" or \"negative\"",
    ),
    (
        "[[robot.joint]]\nnumber = 2\nkind = \"linear\"\n",
        "cell.toml:3:8: robot.joint[2].kind: found \"linear\", expected \"revolute\" or \"prismatic\"",
    ),
    (
        "[[robot.joint]]\nnumber = 7\nname = \"E\"\n",
        "cell.toml:1:1: robot.joint[7].position_min_deg: missing, expected a number from -3600 to 3600",
    ),
    (
        "[[robot.joint]]\nnumber = 8\nname = \"E\"\n",
        "cell.toml:2:10: robot.joint[8].number: found 8, expected a whole number from 1 to 7",
    ),
    (
        "[cartesian]\nspeed_mm_s = 0\n",
        "cell.toml:2:14: cartesian.speed_mm_s: found 0, expected a number from 0.001 to 100000",
    ),
    ("[cartesian]\nspeed = 1500\n", "cell.toml:2:1: cartesian.speed: unknown key, did you mean speed_mm_s?"),
    (
        "[job]\nspeed_unit = \"cm/s\"\n",
        "cell.toml:2:14: job.speed_unit: found \"cm/s\", expected \"mm/s\" or \"cm/min\"",
    ),
    (
        "[job]\nposition_level_mm = [1, 2, 3]\n",
        "cell.toml:2:21: job.position_level_mm: found [1, 2, 3], expected a list of 8 numbers from 0 to 1000",
    ),
    (
        "[job]\nposition_level_mm = [0.5, 1, 2, 3, 4, 6, 5, 10]\n",
        "cell.toml:2:21: job.position_level_mm: found [0.5, 1, 2, 3, 4, 6, 5, 10], expected 8 corner errors (PL 1 to 8), none less than the one before",
    ),
    (
        "[job]\nposition_level_mm = [0.5, 1, 2, 3, 4, 6, -8, 10]\n",
        "cell.toml:2:42: job.position_level_mm[7]: found -8, expected a number from 0 to 1000",
    ),
    (
        "[job]\nposition_level_mm = 3\n",
        "cell.toml:2:21: job.position_level_mm: found 3, expected a list of 8 numbers from 0 to 1000",
    ),
    (
        "[[arc_start]]\nnumber = 1\nvoltage_v = 24.0\nvoltage_percent = 100\n",
        "cell.toml:4:19: arc_start[1].voltage_percent: found 100, expected either voltage_v or voltage_percent, not both",
    ),
    (
        "[[arc_start]]\nnumber = 9\ncurrent_a = 200\n",
        "cell.toml:1:1: arc_start[9].voltage_v: missing, expected this or voltage_percent",
    ),
    (
        "[[arc_start]]\nnumber = 1\ncurrent_a = 22000\n",
        "cell.toml:3:13: arc_start[1].current_a: found 22000, expected a number from 1 to 1000",
    ),
    (
        "[[arc_end]]\nnumber = 1\ndwell_s = 1\n",
        "cell.toml:3:1: arc_end[1].dwell_s: unknown key, expected one of number, name, current_a, voltage_v, voltage_percent, crater_dwell_s, gas_postflow_s",
    ),
    (
        "[[weave]]\nnumber = 1\npattern = \"zigzag\"\n",
        "cell.toml:3:11: weave[1].pattern: found \"zigzag\", expected \"sine\", \"triangle\", \"figure_eight\" or \"circular\"",
    ),
    (
        "[[pass]]\nnumber = 2\nlateral_mm = 60\n",
        "cell.toml:3:14: pass[2].lateral_mm: found 60, expected a number from -50 to 50",
    ),
    (
        "[[weave]]\nnumber = 1\nwavelength_mm = 0\n",
        "cell.toml:3:17: weave[1].wavelength_mm: found 0, expected a number from 0.1 to 1000",
    ),
    (
        "[arc]\nlock_override = \"yes\"\n",
        "cell.toml:2:17: arc.lock_override: found \"yes\", expected true or false",
    ),
    (
        "[sensor]\nlatency_ms = 200\n",
        "cell.toml:2:14: sensor.latency_ms: found 200, expected latency_ms (200) less than age_max_ms (100.0)",
    ),
    (
        "[sensor]\nmean_readings = 2.5\n",
        "cell.toml:2:17: sensor.mean_readings: found 2.5, expected a whole number from 1 to 1000",
    ),
    (
        "[[flexible_mode]]\nnumber = 1\nfrequency_hz = 6.34\ndamping = 1.0\n",
        "cell.toml:4:11: flexible_mode[1].damping: found 1.0, expected a number from 0 to 0.94",
    ),
    (
        "[vibration]\nprefilter = \"FIR\"\n",
        "cell.toml:2:13: vibration.prefilter: found \"FIR\", expected \"none\", \"zv\", \"zvd\", \"fir\", \"fir-zv\", \"fir-zvd\", \"mzv\", \"ei\", \"2hump-ei\" or \"3hump-ei\"",
    ),
    (
        "[vibration]\non = \"speed\"\n",
        "cell.toml:2:6: vibration.on: found \"speed\", expected \"joints\" or \"feedrate\"",
    ),
    (
        "[vibration]\nprefilter = \"zv\"\n",
        "cell.toml:2:13: vibration.prefilter: found \"zv\", expected a [[flexible_mode]] to make the prefilter for",
    ),
    (
        "[vibration]\nprefilter = \"fir-zvd\"\n[[flexible_mode]]\nnumber = 1\nfrequency_hz = 0.8\ndamping = 0.0\n",
        "cell.toml:2:13: vibration.prefilter: found \"fir-zvd\", expected a prefilter of at most 2 s: for these modes it takes 2.50 s",
    ),
    (
        "[vibration]\npath_error_mm = 0\n",
        "cell.toml:2:17: vibration.path_error_mm: found 0, expected a number from 0.01 to 100",
    ),
    (
        "[[io.input]]\nnumber = 4\nvalue = 1\n",
        "cell.toml:3:9: io.input[4].value: found 1, expected true or false",
    ),
    (
        "[[io.input]]\nnumber = 4\nvalue = true\ntoggle_at_s = [3.0, 2.0]\n",
        "cell.toml:4:15: io.input[4].toggle_at_s: found [3.0, 2.0], expected times in ascending order",
    ),
    (
        "[cycle]\nperiod_ms = 1979-05-27\n",
        "cell.toml:2:13: cycle.period_ms: found 1979-05-27, expected a number from 0.1 to 20",
    ),
    (
        "[cycle]\nperiod_ms = 99999999999999999999999\n",
        "cell.toml:2:13: cycle.period_ms: found 99999999999999999999999, expected a number from 0.1 to 20",
    ),
    ("[cycle]\nperiod_us = 1000\n", "cell.toml:2:1: cycle.period_us: unknown key, did you mean period_ms?"),
    (
        "[safety]\nworkspace_min_mm = [0, 0, 4000]\n",
        "cell.toml:2:20: safety.workspace_min_mm: found [0, 0, 4000], expected workspace_min_mm ([0, 0, 4000]) less than workspace_max_mm ([2500.0, 2500.0, 3000.0])",
    ),
    (
        "[safety]\nworkspace_max_mm = [2000, 2000]\n",
        "cell.toml:2:20: safety.workspace_max_mm: found [2000, 2000], expected a list of 3 numbers from -100000 to 100000",
    ),
    (
        "[drive]\nbackend = \"ethercat\"\n",
        "cell.toml:2:11: drive.backend: found \"ethercat\", expected \"simulated\"",
    ),
    (
        "[simulation]\nseed = -1\n",
        "cell.toml:2:8: simulation.seed: found -1, expected a whole number from 0 to 4294967295",
    ),
    (
        "[simulation]\nservo_lag_ms = [15, 15, 15, 15, 15]\n",
        "cell.toml:2:16: simulation.servo_lag_ms: found [15, 15, 15, 15, 15], expected a list of 6 numbers from 0 to 1000",
    ),
    (
        "[simulation]\nservo_lag_ms = [15, 15, 15, 15, 15, -1]\n",
        "cell.toml:2:37: simulation.servo_lag_ms[6]: found -1, expected a number from 0 to 1000",
    ),
    (
        "# Größe\n[cycle]\n'period_ms' = \"größer als üblich, und noch viel mehr als das\"\n",
        "cell.toml:3:15: cycle.period_ms: found \"größer als üblich, und noch viel mehr a…, expected a number from 0.1 to 20",
    ),
    (
        "[cycle]\r\nperiod_ms = 50\r\n",
        "cell.toml:2:13: cycle.period_ms: found 50, expected a number from 0.1 to 20",
    ),
];

#[test]
fn each_mistake_has_its_one_message() {
    let mut wrong = Vec::new();
    for (text, expected) in MISTAKES {
        let found = match Cell::parse(text, "cell.toml") {
            Ok(_) => "accepted".to_owned(),
            Err(error) => error.to_string(),
        };
        if found != *expected {
            wrong.push(format!("    ({text:?},\n     {found:?}),"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), MISTAKES.len(), wrong.join("\n"));
}
