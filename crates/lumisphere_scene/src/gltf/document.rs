//! The JSON of a glTF with its buffers.

use super::container::Container;
use super::extension::{GLTF_EXTENSIONS, check_required};
use super::{Resolve, uri};
use crate::error::item;
use crate::limits::Budget;
use crate::note::note;
use crate::{Encoding, Limits, Note, SceneError};
use gltf_json::Root;
use gltf_json::accessor::Accessor;
use std::borrow::Cow;
use std::collections::HashMap;

/// Memory of an object of the JSON, `{}`, at most: the largest struct of `gltf_json`, with what it holds.
const OBJECT_BYTES: u64 = 1024;
/// Memory of an item of a list at most.
const ITEM_BYTES: u64 = 48;

/// A glTF being read.
pub(super) struct Document<'a> {
    pub root: Root,
    pub buffers: Vec<Cow<'a, [u8]>>,
    pub budget: Budget,
    pub notes: Vec<Note>,
    /// Meshes read so far, by what they were made of.
    pub meshes: HashMap<super::geometry::MeshKey, usize>,
    /// Materials read so far; `None` is glTF's default.
    pub materials: HashMap<Option<usize>, usize>,
    /// Textures read so far, by image.
    pub textures: HashMap<(usize, Encoding), usize>,
}

impl<'a> Document<'a> {
    /// Parses the JSON and gets the buffers.
    pub(super) fn new(container: &Container<'a>, limits: &Limits, resolve: Resolve<'_>) -> Result<Self, SceneError> {
        let mut budget = Budget::new(limits);
        budget.take(|| "the JSON".to_owned(), parsed_bytes(container.json), 1)?;
        let json = |e: serde_json::Error| SceneError::Json { message: e.to_string() };
        let root: Root = serde_json::from_slice(container.json).map_err(json)?;
        if root.asset.version != "2" && !root.asset.version.starts_with("2.") {
            return Err(SceneError::invalid("the version of the glTF", format!("{:?}", root.asset.version), "2.0"));
        }
        check_required(&root.extensions_required)?;
        let mut document = Self {
            root,
            buffers: Vec::new(),
            budget,
            notes: Vec::new(),
            meshes: HashMap::new(),
            materials: HashMap::new(),
            textures: HashMap::new(),
        };
        document.get_buffers(container.binary, resolve)?;
        Ok(document)
    }

    fn get_buffers(&mut self, binary: Option<&'a [u8]>, resolve: Resolve<'_>) -> Result<(), SceneError> {
        for (i, buffer) in self.root.buffers.iter().enumerate() {
            let what = format!("buffer {i}");
            let bytes = match (&buffer.uri, binary) {
                (Some(uri), _) => {
                    let bytes = uri::fetch(&what, uri, &mut *resolve)?;
                    self.budget.take(|| what.clone(), bytes.len() as u64, 1)?;
                    Cow::Owned(bytes)
                }
                (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
                (None, _) => return Err(SceneError::invalid(what, "without a uri", "a uri, or the chunk of a GLB")),
            };
            if (bytes.len() as u64) < buffer.byte_length.0 {
                let found = format!("{} bytes long", bytes.len());
                return Err(SceneError::invalid(what, found, format!("byteLength, {}", buffer.byte_length.0)));
            }
            self.buffers.push(bytes);
        }
        Ok(())
    }

    /// The bytes of a buffer view and the step between its elements, if it gives one.
    pub(super) fn view(&self, index: usize, what: &dyn Fn() -> String) -> Result<(&[u8], Option<usize>), SceneError> {
        let view = item(&self.root.buffer_views, index, what, "buffer view")?;
        let what = || format!("buffer view {index}");
        let buffer = item(&self.buffers, view.buffer.value(), what, "buffer")?;
        let start = view.byte_offset.unwrap_or_default().0;
        let end = start.checked_add(view.byte_length.0);
        let bytes = end.and_then(|end| buffer.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        let bytes = bytes.ok_or_else(|| {
            let found = format!("{} bytes from {start} on", view.byte_length.0);
            SceneError::invalid(what(), found, format!("inside of its buffer of {} bytes", buffer.len()))
        })?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0)))
    }

    /// An accessor.
    pub(super) fn accessor(&self, index: usize, what: &dyn Fn() -> String) -> Result<&Accessor, SceneError> {
        item(&self.root.accessors, index, what, "accessor")
    }

    /// Adds a note.
    pub(super) fn note(&mut self, text: impl Into<String>) {
        note(&mut self.notes, text);
    }

    /// Notes extensions that are not read, animations and skins.
    pub(super) fn note_what_is_left_out(&mut self) {
        let unknown: Vec<String> =
            self.root.extensions_used.iter().filter(|e| !GLTF_EXTENSIONS.contains(&e.as_str())).cloned().collect();
        unknown.into_iter().for_each(|name| self.note(format!("the extension {name} is ignored")));
        let (animations, skins) = (self.root.animations.len(), self.root.skins.len());
        if animations > 0 {
            self.note(format!("{animations} animations are ignored: nodes stand as their own transforms say"));
        }
        if skins > 0 {
            self.note(format!("{skins} skins are ignored: meshes stand as they are stored"));
        }
        if self.root.scenes.len() > 1 {
            self.note(format!("{} scenes beside this one are ignored", self.root.scenes.len() - 1));
        }
    }
}

/// Memory that a JSON may need when parsed, whatever it says. What is in strings, such as data URIs, counts as itself; braces and
/// commas in strings count too much.
fn parsed_bytes(json: &[u8]) -> u64 {
    let of = |byte: &u8| match byte {
        b'{' => OBJECT_BYTES,
        b',' | b'[' => ITEM_BYTES,
        _ => 1,
    };
    json.iter().map(of).sum()
}
