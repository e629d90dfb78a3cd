//! Each text is valid with no more than those that its documentation names, and meets no name of the caller's.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, front::wgsl};
use stochastic_light_culling::wgsl::{
    ANISOTROPIC, BOUND, FRAME, GAUSSIAN, LIGHT, LOBE, NUM, PROJECT, SPOT, TABLE, TIGHT, TOUCH, VIEW,
};

/// What the caller of the tight bound declares.
pub const DECLARED: &str = "@group(0) @binding(0) var<storage, read> slc_table: array<vec4f>;";

/// The module that `texts` make.
pub fn module(texts: &[&str]) -> Module {
    let text = texts.join("\n");
    let module = wgsl::parse_str(&text).unwrap_or_else(|error| {
        panic!("{}", error.emit_to_string(&text));
    });
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|error| {
        panic!("{}", error.emit_to_string(&text));
    });
    module
}

#[test]
fn each_text_is_valid_with_those_that_it_names() {
    module(&[NUM]);
    module(&[LOBE, NUM]);
    module(&[LIGHT, NUM]);
    module(&[BOUND, LOBE, NUM]);
    module(&[DECLARED, TIGHT, BOUND, LOBE, NUM]);
    module(&[PROJECT, BOUND, LOBE, NUM]);
    module(&[TOUCH, PROJECT, BOUND, LOBE, NUM]);
    module(&[SPOT, BOUND, LOBE, NUM]);
    module(&[GAUSSIAN, BOUND, LOBE, NUM]);
    module(&[ANISOTROPIC, LOBE, NUM]);
    module(&[VIEW]);
}

#[test]
fn all_names_have_the_prefix_and_nothing_is_bound() {
    let texts = [
        NUM,
        LOBE,
        LIGHT,
        BOUND,
        TIGHT,
        SPOT,
        GAUSSIAN,
        ANISOTROPIC,
        PROJECT,
        TOUCH,
        VIEW,
    ];
    let module = module(&[&[DECLARED], &texts[..]].concat());
    let functions = module.functions.iter().map(|(_, function)| &function.name);
    for name in functions.flatten() {
        assert!(name.starts_with("slc_"), "{name}");
    }
    let constants = module.constants.iter().map(|(_, constant)| &constant.name);
    for name in constants.flatten() {
        assert!(name.starts_with("SLC_"), "{name}");
    }
    for name in module
        .types
        .iter()
        .filter_map(|(_, kind)| kind.name.as_ref())
    {
        assert!(name.starts_with("Slc"), "{name}");
    }
    assert!(module.entry_points.is_empty());
    assert_eq!(module.global_variables.len(), 1, "the table of the caller");
    for line in texts.iter().flat_map(|text| text.lines()) {
        let is_directive =
            ["enable", "requires", "diagnostic", "#"].map(|word| line.starts_with(word));
        assert_eq!(is_directive, [false; 4], "{line}");
    }
}

/// Each line of the table in the documentation is a constant of the file that it names, with that value, and there are no
/// other budgets.
#[test]
fn budgets_are_those_that_are_counted() {
    let page = include_str!("../../docs/rounding.md");
    let files = [
        ("light.wgsl", LIGHT),
        ("bound.wgsl", BOUND),
        ("tight.wgsl", TIGHT),
        ("gaussian.wgsl", GAUSSIAN),
        ("project.wgsl", PROJECT),
        ("frame.wgsl", FRAME),
    ];
    let rows = page.lines().filter(|line| line.starts_with("| `SLC_"));
    let mut counted = 0;
    for row in rows {
        let cells: Vec<_> = row
            .split('|')
            .map(|cell| cell.trim().trim_matches('`'))
            .collect();
        let [_, name, value, file, ..] = cells[..] else {
            panic!("{row}");
        };
        let (_, text) = files
            .iter()
            .find(|(known, _)| *known == file)
            .expect("a file");
        assert!(
            text.contains(&format!("const {name}: f32 = {value}.0;")),
            "{row}"
        );
        counted += 1;
    }
    let texts = [
        NUM,
        LOBE,
        LIGHT,
        BOUND,
        TIGHT,
        SPOT,
        GAUSSIAN,
        ANISOTROPIC,
        PROJECT,
        TOUCH,
        VIEW,
        FRAME,
    ]
    .concat();
    assert_eq!(texts.matches("_ULPS: f32 = ").count(), counted);
}

#[test]
fn the_table_has_the_size_that_the_text_expects() {
    let text = format!("{NUM}{LOBE}{BOUND}{TIGHT}");
    assert!(text.contains("SLC_KNOTS: vec3u = vec3u(9u, 21u, 7u)"));
    assert_eq!(TABLE.len(), 9 * 21 * 7);
}
