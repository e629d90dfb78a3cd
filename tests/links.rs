//! Links of the pages: each leads to a file and a heading that exist, and from the pages at the root to files of the
//! package, so that they also lead there for whoever has the package alone.

use std::{collections::BTreeSet, fs, path::Path, process::Command};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

const PAGES: [&str; 9] = [
    "README.md",
    "CHANGELOG.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "docs/choosing.md",
    "docs/guide.md",
    "docs/performance.md",
    "docs/rounding.md",
    "docs/report/report.md",
];

#[test]
fn links_lead_to_files_and_headings() {
    let packaged = packaged_files();
    let mut count = 0;
    for page in PAGES {
        for link in Page::read(page).links {
            if link.contains("://") {
                continue;
            }
            let (path, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target = if path.is_empty() {
                page.to_owned()
            } else {
                beside(page, path)
            };
            assert!(
                Path::new(ROOT).join(&target).is_file(),
                "{page}: no file {link}"
            );
            if !heading.is_empty() {
                let anchors = Page::read(&target).anchors;
                assert!(anchors.contains(heading), "{page}: no heading {link}");
            }
            if !page.starts_with("docs/") {
                assert!(
                    packaged.contains(&target),
                    "{page}: not in the package: {link}"
                );
            }
            count += 1;
        }
    }
    assert!(count > 20, "{count} links");
}

/// What a page links to, and what can be linked to in it.
struct Page {
    links: Vec<String>,
    anchors: BTreeSet<String>,
}

impl Page {
    fn read(page: &str) -> Self {
        let text = fs::read_to_string(Path::new(ROOT).join(page)).expect("page");
        let (mut links, mut anchors) = (Vec::new(), BTreeSet::new());
        let mut heading = None;
        for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    links.push(dest_url.into_string());
                }
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => {
                    anchors.extend(heading.take().as_deref().map(anchor));
                }
                Event::Text(text) | Event::Code(text) => {
                    if let Some(heading) = &mut heading {
                        heading.push_str(&text);
                    }
                }
                _ => {}
            }
        }
        Self { links, anchors }
    }
}

/// Anchor of a heading, as forges make it.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    heading
        .to_lowercase()
        .chars()
        .filter(kept)
        .collect::<String>()
        .replace(' ', "-")
}

/// Path from the root that a link of a page means.
fn beside(page: &str, link: &str) -> String {
    let mut parts: Vec<_> = page.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

fn packaged_files() -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--quiet"])
        .current_dir(ROOT)
        .output()
        .expect("cargo runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let list = String::from_utf8(output.stdout).expect("UTF-8");
    list.lines().map(|path| path.replace('\\', "/")).collect()
}
