//! The example `stability` as a command: its numbers, and what it refuses.

use serde_json::Value;
use support::command;

#[test]
fn prints_one_object_and_loses_no_light() {
    let output = command::run("stability", ["--json", "--cases", "20000"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("JSON is UTF-8");
    assert_eq!(text.lines().count(), 1);
    let object: Value = serde_json::from_str(&text).expect("JSON");
    let names = |value: &Value| -> Vec<String> {
        let object = value.as_object().expect("an object");
        object.keys().cloned().collect()
    };
    assert_eq!(
        names(&object),
        [
            "cases",
            "lost",
            "lost_by_direct_port",
            "mean_volume_inflation",
            "max_relative_error"
        ]
    );
    let errors = &object["max_relative_error"];
    assert_eq!(
        names(errors),
        ["ndf", "g1", "fresnel", "fresnel_max", "range"]
    );
    assert_eq!(object["cases"], 20_000);
    assert_eq!(object["lost"], 0);
    assert!(object["lost_by_direct_port"].as_u64() > Some(0));
    let inflation = object["mean_volume_inflation"].as_f64().expect("a number");
    assert!((0.0..0.01).contains(&inflation), "{inflation}");
    for name in names(errors) {
        let error = errors[&name].as_f64().expect("a number");
        assert!((0.0..1.0).contains(&error), "{name}: {error}");
    }
    let tables = String::from_utf8(output.stderr).expect("tables are UTF-8");
    assert!(tables.contains("20000 cases, 0 lost"), "{tables}");
}

#[test]
fn refuses_what_it_does_not_know() {
    for argument in [
        "--cases=0",
        "--cases=-1",
        "--cases=many",
        "--case",
        "--alpha=1",
        "extra",
    ] {
        command::assert_refusal(&command::run("stability", [argument]), "");
    }
}
