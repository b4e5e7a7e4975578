//! Numbers out of buffers (glTF 2.0, section 3.6.2).

use super::document::Document;
use crate::SceneError;
use crate::error::item;
use gltf_json::accessor::{Accessor, ComponentType, Type};
use gltf_json::validation::Checked;

/// Elements in a buffer, all of them inside of it.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Elements<'a> {
    /// `count` elements of `size` bytes from `offset` on.
    fn new(
        bytes: &'a [u8],
        offset: u64,
        stride: Option<usize>,
        [count, size]: [usize; 2],
        what: &dyn Fn() -> String,
    ) -> Result<Self, SceneError> {
        let stride = stride.unwrap_or(size);
        if stride < size {
            let what = format!("{}: byteStride", what());
            return Err(SceneError::invalid(what, stride, format!("at least {size}, the size of an element")));
        }
        let end = match count.checked_sub(1) {
            None => Some(offset),
            Some(steps) => (steps as u64)
                .checked_mul(stride as u64)
                .and_then(|n| n.checked_add(size as u64))
                .and_then(|n| n.checked_add(offset)),
        };
        let inside = end.filter(|end| *end <= bytes.len() as u64);
        if inside.is_none() {
            let found = format!("{count} elements of {size} bytes, {stride} apart, from {offset} on");
            return Err(SceneError::invalid(
                what(),
                found,
                format!("inside of its buffer view of {} bytes", bytes.len()),
            ));
        }
        Ok(Self { bytes: &bytes[offset as usize..], stride, size })
    }

    fn get(&self, index: usize) -> &'a [u8] {
        &self.bytes[index * self.stride..][..self.size]
    }
}

impl Document<'_> {
    /// Numbers of an accessor of N components, normalised where it says so, all finite.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        index: usize,
        what: &dyn Fn() -> String,
    ) -> Result<Vec<[f32; N]>, SceneError> {
        let accessor = self.accessor(index, what)?.clone();
        let name = || format!("{}: accessor {index}", what());
        let (kind, component) = shape(&accessor, &name)?;
        if kind.multiplicity() != N || matches!(kind, Type::Mat2 | Type::Mat3 | Type::Mat4) {
            return Err(SceneError::invalid(name(), format!("{kind:?}"), format!("{N} components")));
        }
        let count = self.element_count(&accessor, N * size_of::<f32>(), &name)?;
        let size = N * component.size();
        let number = |bytes: &[u8]| -> [f32; N] {
            std::array::from_fn(|i| float(component, accessor.normalized, &bytes[i * component.size()..]))
        };
        let mut values = match self.elements(&accessor, [count, size], &name)? {
            Some(elements) => (0..count).map(|i| number(elements.get(i))).collect(),
            None => vec![[0.0; N]; count],
        };
        self.replace_sparse(&accessor, size, &name, |at, bytes| values[at] = number(bytes))?;
        match values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            Some(at) => Err(SceneError::invalid(format!("{}: element {at}", name()), "not finite", "finite numbers")),
            None => Ok(values),
        }
    }

    /// Indices of an accessor.
    pub(super) fn indices(&mut self, index: usize, what: &dyn Fn() -> String) -> Result<Vec<u32>, SceneError> {
        let accessor = self.accessor(index, what)?.clone();
        let name = || format!("{}: accessor {index}", what());
        let (kind, component) = shape(&accessor, &name)?;
        if kind != Type::Scalar {
            return Err(SceneError::invalid(name(), format!("{kind:?}"), "scalars, for they are indices"));
        }
        let count = self.element_count(&accessor, size_of::<u32>(), &name)?;
        let wrong = || SceneError::invalid(name(), format!("{component:?}"), "U8, U16 or U32, for they are indices");
        unsigned(component, &[0; 4]).ok_or_else(wrong)?;
        let number = |bytes: &[u8]| unsigned(component, bytes).unwrap_or(0);
        let mut values = match self.elements(&accessor, [count, component.size()], &name)? {
            Some(elements) => (0..count).map(|i| number(elements.get(i))).collect(),
            None => vec![0; count],
        };
        self.replace_sparse(&accessor, component.size(), &name, |at, bytes| values[at] = number(bytes))?;
        Ok(values)
    }

    /// How many elements there are, taken from the budget at `bytes` each.
    fn element_count(
        &mut self,
        accessor: &Accessor,
        bytes: usize,
        name: &dyn Fn() -> String,
    ) -> Result<usize, SceneError> {
        self.budget.take(name, accessor.count.0, bytes)?;
        usize::try_from(accessor.count.0).map_err(|_| SceneError::invalid(name(), accessor.count.0, "fewer elements"))
    }

    fn elements(
        &self,
        accessor: &Accessor,
        shape: [usize; 2],
        name: &dyn Fn() -> String,
    ) -> Result<Option<Elements<'_>>, SceneError> {
        let Some(view) = accessor.buffer_view else { return Ok(None) };
        let (bytes, stride) = self.view(view.value(), name)?;
        Elements::new(bytes, accessor.byte_offset.unwrap_or_default().0, stride, shape, name).map(Some)
    }

    /// Calls `replace` with each element that is stored apart, and its number.
    fn replace_sparse(
        &self,
        accessor: &Accessor,
        size: usize,
        name: &dyn Fn() -> String,
        mut replace: impl FnMut(usize, &[u8]),
    ) -> Result<(), SceneError> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let name = || format!("{}: sparse", name());
        let Checked::Valid(component) = &sparse.indices.component_type else {
            return Err(SceneError::invalid(name(), "an unknown componentType", "U8, U16 or U32"));
        };
        if sparse.count.0 > accessor.count.0 {
            let expected = format!("at most {}, the accessor's", accessor.count.0);
            return Err(SceneError::invalid(format!("{}: count", name()), sparse.count.0, expected));
        }
        let (count, component) = (sparse.count.0 as usize, component.0);
        let (bytes, stride) = self.view(sparse.indices.buffer_view.value(), &name)?;
        let at = Elements::new(bytes, sparse.indices.byte_offset.0, stride, [count, component.size()], &name)?;
        let (bytes, stride) = self.view(sparse.values.buffer_view.value(), &name)?;
        let values = Elements::new(bytes, sparse.values.byte_offset.0, stride, [count, size], &name)?;
        for i in 0..count {
            let index = unsigned(component, at.get(i))
                .ok_or_else(|| SceneError::invalid(name(), format!("{component:?}"), "U8, U16 or U32"))?;
            if u64::from(index) >= accessor.count.0 {
                let expected = format!("below {}", accessor.count.0);
                return Err(SceneError::invalid(format!("{}: index {i}", name()), index, expected));
            }
            replace(index as usize, values.get(i));
        }
        Ok(())
    }

    /// How many components an accessor's elements have.
    pub(super) fn component_count(&self, index: usize, what: &dyn Fn() -> String) -> Result<usize, SceneError> {
        let accessor = item(&self.root.accessors, index, what, "accessor")?;
        Ok(shape(accessor, what)?.0.multiplicity())
    }
}

fn shape(accessor: &Accessor, name: &dyn Fn() -> String) -> Result<(Type, ComponentType), SceneError> {
    match (&accessor.type_, &accessor.component_type) {
        (Checked::Valid(kind), Checked::Valid(component)) => Ok((*kind, component.0)),
        _ => Err(SceneError::invalid(name(), "of an unknown type or componentType", "one of glTF 2.0")),
    }
}

/// A component; `bytes` holds at least one.
fn float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let scaled = |x: f32, largest: f32| if normalized { (x / largest).max(-1.0) } else { x };
    let (half, word) = (bytes.first_chunk().copied(), bytes.first_chunk().copied());
    match component {
        ComponentType::I8 => scaled(f32::from(bytes[0] as i8), 127.0),
        ComponentType::U8 => scaled(f32::from(bytes[0]), 255.0),
        ComponentType::I16 => scaled(half.map_or(0.0, |b| f32::from(i16::from_le_bytes(b))), 32767.0),
        ComponentType::U16 => scaled(half.map_or(0.0, |b| f32::from(u16::from_le_bytes(b))), 65535.0),
        ComponentType::U32 => scaled(word.map_or(0.0, |b| u32::from_le_bytes(b) as f32), u32::MAX as f32),
        ComponentType::F32 => word.map_or(0.0, f32::from_le_bytes),
    }
}

/// An index; `None` if the type is none of indices, or if there are too few bytes.
fn unsigned(component: ComponentType, bytes: &[u8]) -> Option<u32> {
    match component {
        ComponentType::U8 => bytes.first().map(|b| u32::from(*b)),
        ComponentType::U16 => bytes.first_chunk().map(|b| u32::from(u16::from_le_bytes(*b))),
        ComponentType::U32 => bytes.first_chunk().map(|b| u32::from_le_bytes(*b)),
        ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => None,
    }
}
