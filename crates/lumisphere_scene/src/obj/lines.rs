//! The lines of an OBJ file.

use super::group::{Corner, Group};
use crate::note::note;
use crate::{Note, SceneError};

/// Coordinates beyond this are refused, as those of a glTF are.
const LARGEST: f32 = 1e15;

/// What faces refer to.
#[derive(Default)]
pub(super) struct Vertices {
    pub positions: Vec<[f32; 3]>,
    /// As many as positions; white where a line has none.
    pub colors: Vec<[f32; 4]>,
    pub uv: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
}

/// A file, read.
#[derive(Default)]
pub(super) struct Reader {
    pub vertices: Vertices,
    /// Those with faces.
    pub groups: Vec<Group>,
    /// Names of material libraries.
    pub libraries: Vec<String>,
    open: Group,
}

impl Reader {
    pub(super) fn read(text: &str, notes: &mut Vec<Note>) -> Result<Self, SceneError> {
        let mut reader = Self::default();
        // A backslash continues a line.
        let text = text.replace("\\\r\n", " ").replace("\\\n", " ");
        for (i, line) in text.lines().enumerate() {
            reader.line(line, notes).map_err(|m| SceneError::Obj { message: format!("line {}: {m}", i + 1) })?;
        }
        reader.close();
        Ok(reader)
    }

    fn line(&mut self, line: &str, notes: &mut Vec<Note>) -> Result<(), String> {
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or_default();
        let rest = || line.trim_start()[key.len()..].trim().to_owned();
        let vertices = &mut self.vertices;
        match key {
            "v" => {
                let n = numbers(words)?;
                vertices.positions.push(first(&n)?);
                // x y z, x y z w, or x y z r g b.
                vertices.colors.push(n.get(3..6).map_or([1.0; 4], |c| [c[0], c[1], c[2], 1.0]));
            }
            "vn" => vertices.normals.push(first(&numbers(words)?)?),
            "vt" => {
                let n = numbers(words)?;
                // v runs upwards in OBJ.
                let u = *n.first().ok_or("a vt without a number")?;
                vertices.uv.push([u, 1.0 - n.get(1).copied().unwrap_or(0.0)]);
            }
            "f" => {
                let corners = words.map(|word| self.corner(word)).collect::<Result<Vec<_>, _>>()?;
                if corners.len() < 3 {
                    return Err(format!("a face of {} corners, expected at least 3", corners.len()));
                }
                self.open.add_polygon(&corners);
            }
            "o" | "g" => {
                self.close();
                self.open.name = rest();
            }
            "usemtl" => {
                self.close();
                self.open.material = rest();
            }
            "mtllib" => self.libraries.push(rest()),
            "l" | "p" => note(notes, "lines and points are ignored"),
            "" | "s" | "vp" => {}
            comment if comment.starts_with('#') => {}
            _ => note(notes, "lines of other kinds of the OBJ file are ignored"),
        }
        Ok(())
    }

    /// Ends a group; the next has its name and material until told otherwise.
    fn close(&mut self) {
        let next = Group { name: self.open.name.clone(), material: self.open.material.clone(), ..Group::default() };
        let group = std::mem::replace(&mut self.open, next);
        if !group.triangles.is_empty() {
            self.groups.push(group);
        }
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut parts = word.split('/');
        let mut index = |what: &str, count: usize| match parts.next() {
            None | Some("") => Ok(None),
            Some(text) => resolved(text, count)
                .map(Some)
                .ok_or_else(|| format!("a face refers to {what} {text}, expected 1 to {count} or -{count} to -1")),
        };
        let position = index("vertex", self.vertices.positions.len())?;
        let uv = index("texture coordinate", self.vertices.uv.len())?;
        let normal = index("normal", self.vertices.normals.len())?;
        Ok(Corner { position: position.ok_or("a corner without a vertex")?, uv, normal })
    }
}

/// Indices start at 1; those below 0 count from the last.
fn resolved(text: &str, count: usize) -> Option<u32> {
    let index: i64 = text.parse().ok()?;
    let from_first = if index < 0 { index.checked_add(i64::try_from(count).ok()?)? } else { index - 1 };
    let from_first = u32::try_from(from_first).ok()?;
    ((from_first as usize) < count).then_some(from_first)
}

fn numbers<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vec<f32>, String> {
    let number = |word: &str| word.parse().ok().filter(|x: &f32| x.abs() <= LARGEST);
    words.map(|word| number(word).ok_or_else(|| format!("{word:?}, expected a number of at most {LARGEST}"))).collect()
}

fn first(numbers: &[f32]) -> Result<[f32; 3], String> {
    numbers.first_chunk().copied().ok_or_else(|| format!("{} numbers, expected 3", numbers.len()))
}
