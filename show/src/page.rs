//! The page's text.

use crate::channel::{Channel, Rounding, pack};
use crate::mesh::{self, MeshHead};
use crate::{Column, Live, Mechanism, Mesh, Reaction, Run, Scale, Scene};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::Serialize;
use std::io::Write;

/// How every page begins.
pub const MARK: &str = "<!doctype html><!-- written by gyro show -->";

/// The frame into which program and data are set.
const SHELL: &str = include_str!("shell.html");

/// The page's program, compressed.
const VIEWER: &[u8] = include_bytes!("../assets/viewer.js.deflate");

/// Positions and directions: a 30 000th of a quantity's range is far below a pixel.
const POSE: Rounding = Rounding::Bits(15);

/// Velocities of bodies, of which four digits are read.
const VELOCITY: Rounding = Rounding::Bits(13);

/// Numbers that are read and zoomed into: a millionth of a quantity's range.
const PLOTTED: Rounding = Rounding::Bits(20);

/// Times of samples: evenly spaced ones take no room, however finely.
const TIME: Rounding = Rounding::Bits(30);

/// The text of a page that shows these runs over one another; the first is the one that leads, and the one that is
/// computed in the page if the mechanism comes with it.
pub fn page(title: &str, scenes: &[Scene], live: Option<&Live>) -> String {
    let mut bytes = Vec::new();
    let mut meshes = Vec::new();
    let scenes = scenes.iter().map(|scene| head(scene, &mut meshes, &mut bytes)).collect();
    let meshes = meshes.into_iter().map(|mesh| mesh::head(mesh, &mut bytes)).collect();
    let head = Head { title, scenes, meshes, live };
    let json = serde_json::to_string(&head).expect("plain data has no keys but strings");
    SHELL
        .replace("{{mark}}", MARK)
        .replace("{{title}}", &escape(title))
        .replace("{{viewer}}", &STANDARD.encode(VIEWER))
        .replace("{{module}}", &live.map_or_else(String::new, |live| STANDARD.encode(deflate(&live.module))))
        .replace("{{numbers}}", &STANDARD.encode(deflate(&bytes)))
        // Last, as names may be anything; no script ends within a string.
        .replace("{{head}}", &json.replace('<', "\\u003c"))
}

/// What the page's program is told.
#[derive(Serialize)]
struct Head<'a> {
    title: &'a str,
    scenes: Vec<SceneHead<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<MeshHead>,
    #[serde(skip_serializing_if = "Option::is_none")]
    live: Option<&'a Live>,
}

#[derive(Serialize)]
struct SceneHead<'a> {
    name: &'a str,
    mechanism: &'a Mechanism,
    n: usize,
    time: Channel,
    bodies: Vec<BodyHead>,
    columns: Vec<ColumnHead<'a>>,
    reactions: &'a [Reaction],
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    events: &'a [(f64, String)],
    /// Which of the page's meshes those of the mechanism are.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<usize>,
}

/// Channels of a body: seven of its pose and six of its velocities, which a body that stands still lacks.
#[derive(Serialize)]
struct BodyHead {
    pose: Vec<Channel>,
    velocity: Vec<Channel>,
}

#[derive(Serialize)]
struct ColumnHead<'a> {
    group: &'a str,
    title: &'a str,
    name: &'a str,
    unit: &'a str,
    channel: Channel,
}

/// `meshes` are those of the whole page.
fn head<'a>(scene: &'a Scene, meshes: &mut Vec<&'a Mesh>, bytes: &mut Vec<u8>) -> SceneHead<'a> {
    let Scene { name, mechanism, run } = scene;
    let Run { times, poses, velocities, columns, reactions, events } = run;
    let time = pack(times, TIME, bytes);
    let body = |(b, poses): (usize, &Vec<[f64; 7]>)| BodyHead {
        pose: (0..7).map(|k| pack(&part(poses, k), POSE, bytes)).collect(),
        velocity: match velocities.get(b) {
            Some(velocities) if !velocities.is_empty() => {
                (0..6).map(|k| pack(&part(velocities, k), VELOCITY, bytes)).collect()
            }
            _ => Vec::new(),
        },
    };
    let bodies = poses.iter().enumerate().map(body).collect();
    let column = |column: &'a Column| {
        let rounding = if column.scale == Scale::Log { Rounding::Octaves } else { PLOTTED };
        let channel = pack(&column.values, rounding, bytes);
        let Column { group, title, name, unit, .. } = column;
        ColumnHead { group, title, name, unit, channel }
    };
    let columns = columns.iter().map(column).collect();
    let place = |mesh: &'a Mesh| {
        meshes.iter().position(|other| *other == mesh).unwrap_or_else(|| {
            meshes.push(mesh);
            meshes.len() - 1
        })
    };
    let meshes = mechanism.meshes.iter().map(place).collect();
    SceneHead { name, mechanism, n: times.len(), time, bodies, columns, reactions, events, meshes }
}

fn part<const N: usize>(rows: &[[f64; N]], k: usize) -> Vec<f64> {
    rows.iter().map(|row| row[k]).collect()
}

pub(crate) fn deflate(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory takes all that is written")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;

    #[test]
    fn names_cannot_end_the_script() {
        let body = Body { name: "</script><script>alert(1)//{{numbers}}".to_owned(), ..Body::default() };
        let mechanism = Mechanism { bodies: vec![body], ..Mechanism::default() };
        let still = vec![[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]];
        let run = Run { times: vec![0.0, 1.0], poses: vec![still], ..Run::default() };
        let html = page("<b>&", &[Scene { name: "run".to_owned(), mechanism, run }], None);
        assert!(html.starts_with(MARK) && html.contains("<title>&lt;b>&amp;</title>"));
        assert!(!html.contains("alert(1)//{{numbers}}\"") || html.contains("\\u003c/script>"));
        assert!(!html.contains("</script><script>alert"), "a name has ended the script");
        for word in ["http://", "https://", "src=", "<link"] {
            assert!(!SHELL.contains(word), "the page asks the network: {word}");
        }
    }
}
