//! Turns and mirrors that take axes to axes: signed permutations of x, y and z.

use crate::rotation::Rotation;
use crate::vector::Vec3;
use std::f64::consts::FRAC_PI_2;
use std::fmt;
use std::str::FromStr;

/// One of the 48 maps of the sphere that take every axis to an axis: 24 rotations and 24 mirrors.
///
/// Written as the three components of what (x, y, z) becomes: "x y -z" is the mirror in z, "-z y x" takes (x, y, z) to
/// (-z, y, x). A *turned* picture C' of a picture C holds, at the fetch direction d, what C holds at turn(d):
/// L'(d) = L(turn d). So "x y -z" is what a left-handed engine wants whose +z is our -Z, and turning by `a` and the
/// result by `b` is turning by `a.then_after(b)`.
///
/// ```
/// use lumisphere_sphere::{AxisTurn, AxisTurnError};
///
/// let turn: AxisTurn = "z y -x".parse()?;
/// assert_eq!(turn.apply([1.0, 2.0, 3.0]), [3.0, 2.0, -1.0]);
/// assert_eq!(turn.to_string(), "z y -x");
/// assert!(!turn.is_mirror());
/// # Ok::<(), AxisTurnError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct AxisTurn {
    /// Where each component comes from, and its sign.
    components: [Component; 3],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Component {
    /// 0 for x, 1 for y, 2 for z.
    axis: usize,
    /// 1 or -1.
    sign: i8,
}

/// What is no turn of axes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AxisTurnError {
    /// A text of another form.
    #[error("expected x, y and z, each once and with or without a sign, such as \"x y -z\", found \"{found}\"")]
    Text {
        /// The text.
        found: String,
    },
    /// A matrix that takes an axis off the axes.
    #[error("expected one entry of 1 or -1 in each row and column and zeros elsewhere, found {found:?}")]
    Matrix {
        /// The matrix, row by row.
        found: [Vec3; 3],
    },
}

/// How far an entry of a matrix may be from -1, 0 or 1: sines and cosines of quarter turns are off by 1e-16,
/// matrices copied from a file of f32 by 1e-7.
const ENTRY: f64 = 1e-6;

impl AxisTurn {
    /// No turn.
    pub const IDENTITY: Self = Self::signs([1, 1, 1]);
    /// (x, y, -z): between our axes and left-handed ones with x right, y up and z forward.
    pub const MIRROR_Z: Self = Self::signs([1, 1, -1]);

    const fn signs(signs: [i8; 3]) -> Self {
        let [x, y, z] = signs;
        Self {
            components: [
                Component { axis: 0, sign: x },
                Component { axis: 1, sign: y },
                Component { axis: 2, sign: z },
            ],
        }
    }

    /// From components in any number of repetitions, or `None` unless each axis occurs once.
    fn from_components(components: [Component; 3]) -> Option<Self> {
        let seen = components.iter().fold(0, |seen, c| seen | 1 << c.axis);
        (seen == 0b111).then_some(Self { components })
    }

    /// All 48, [`IDENTITY`](Self::IDENTITY) first.
    pub fn all() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        ORDERS.into_iter().flat_map(|order| {
            (0..8).map(move |signs| Self {
                components: std::array::from_fn(|i| Component {
                    axis: order[i],
                    sign: if signs >> i & 1 == 0 { 1 } else { -1 },
                }),
            })
        })
    }

    /// The turn of a matrix given row by row: turn(d) = M d. Entries may be 1e-6 off.
    ///
    /// # Errors
    /// [`AxisTurnError::Matrix`] unless M is a signed permutation.
    pub fn from_matrix(rows: [Vec3; 3]) -> Result<Self, AxisTurnError> {
        let mut components = [Component { axis: 0, sign: 1 }; 3];
        for (row, component) in rows.iter().zip(&mut components) {
            for (axis, &entry) in row.iter().enumerate() {
                if (entry.abs() - 1.0).abs() <= ENTRY {
                    *component = Component { axis, sign: if entry > 0.0 { 1 } else { -1 } };
                } else if entry.is_nan() || entry.abs() > ENTRY {
                    return Err(AxisTurnError::Matrix { found: rows });
                }
            }
        }
        let unit_rows = rows.iter().all(|row| (row.iter().map(|e| e.abs()).sum::<f64>() - 1.0).abs() <= 3.0 * ENTRY);
        Self::from_components(components).filter(|_| unit_rows).ok_or(AxisTurnError::Matrix { found: rows })
    }

    /// The matrix, row by row.
    pub fn rows(&self) -> [Vec3; 3] {
        self.components.map(|c| std::array::from_fn(|axis| if axis == c.axis { f64::from(c.sign) } else { 0.0 }))
    }

    /// turn(v), without rounding.
    #[inline]
    pub fn apply(&self, v: Vec3) -> Vec3 {
        self.components.map(|c| f64::from(c.sign) * v[c.axis])
    }

    /// The turn that undoes this one.
    pub fn inverse(&self) -> Self {
        let mut components = self.components;
        for (axis, c) in self.components.iter().enumerate() {
            components[c.axis] = Component { axis, sign: c.sign };
        }
        Self { components }
    }

    /// The product `self · first`: `first` acts first on a direction.
    pub fn then_after(&self, first: Self) -> Self {
        let component = |c: Component| {
            let inner = first.components[c.axis];
            Component { axis: inner.axis, sign: c.sign * inner.sign }
        };
        Self { components: self.components.map(component) }
    }

    /// Whether the turn changes the handedness of what it turns.
    pub fn is_mirror(&self) -> bool {
        let [a, b, c] = self.components.map(|c| c.axis);
        let swaps = [a > b, a > c, b > c];
        let negative = self.components.iter().filter(|c| c.sign < 0).count();
        (swaps.iter().filter(|&&swap| swap).count() + negative) % 2 == 1
    }

    /// The rotation R with R d = turn(d), its entries within 1e-15; `None` for a mirror.
    pub fn to_rotation(&self) -> Option<Rotation> {
        let quarter = |turns: u32| f64::from(turns % 4) * FRAC_PI_2;
        // Yaw, pitch and roll by quarter turns reach all 24.
        (0..64)
            .map(|i| Rotation::from_yaw_pitch_roll(quarter(i), quarter(i / 4), quarter(i / 16)))
            .find(|rotation| Self::from_matrix(rotation.rows()).as_ref() == Ok(self))
    }
}

impl fmt::Display for AxisTurn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, c) in self.components.iter().enumerate() {
            let space = if i == 0 { "" } else { " " };
            let sign = if c.sign < 0 { "-" } else { "" };
            write!(f, "{space}{sign}{}", ["x", "y", "z"][c.axis])?;
        }
        Ok(())
    }
}

impl FromStr for AxisTurn {
    type Err = AxisTurnError;

    /// Three components apart by spaces or commas, each x, y or z (or a capital) after an optional sign.
    fn from_str(text: &str) -> Result<Self, AxisTurnError> {
        let wrong = || AxisTurnError::Text { found: text.to_owned() };
        let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        let components = words.map(component).collect::<Option<Vec<_>>>().ok_or_else(wrong)?;
        let components = components.try_into().map_err(|_| wrong())?;
        Self::from_components(components).ok_or_else(wrong)
    }
}

/// "x", "+y", "-z".
fn component(word: &str) -> Option<Component> {
    let (sign, name) = match word.strip_prefix('-') {
        Some(name) => (-1, name),
        None => (1, word.strip_prefix('+').unwrap_or(word)),
    };
    let axis = ["x", "y", "z"].iter().position(|axis| axis.eq_ignore_ascii_case(name))?;
    Some(Component { axis, sign })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::vector::{cross, dot};
    use std::collections::HashSet;

    const V: Vec3 = [1.0, 2.0, 3.0];

    fn determinant(rows: [Vec3; 3]) -> f64 {
        dot(rows[0], cross(rows[1], rows[2]))
    }

    #[test]
    fn there_are_48_and_half_of_them_are_mirrors() {
        let images: HashSet<String> = AxisTurn::all().map(|turn| format!("{:?}", turn.apply(V))).collect();
        assert_eq!(images.len(), 48);
        assert_eq!(AxisTurn::all().next(), Some(AxisTurn::IDENTITY));
        for turn in AxisTurn::all() {
            assert_eq!(determinant(turn.rows()), if turn.is_mirror() { -1.0 } else { 1.0 }, "{turn}");
        }
        assert_eq!(AxisTurn::all().filter(AxisTurn::is_mirror).count(), 24);
    }

    #[test]
    fn text_and_matrix_give_the_turn_back() {
        for turn in AxisTurn::all() {
            assert_eq!(turn.to_string().parse(), Ok(turn));
            assert_eq!(AxisTurn::from_matrix(turn.rows()), Ok(turn));
            let product = turn.rows().map(|row| dot(row, V));
            assert_eq!(product, turn.apply(V), "{turn}");
        }
        assert_eq!("  +X,y  -Z ".parse(), Ok(AxisTurn::MIRROR_Z));
        // The direction that cmft's cubes hold at (x, y, z): a mirror.
        let cmft: AxisTurn = "z y x".parse().unwrap();
        assert_eq!(cmft.apply(V), [3.0, 2.0, 1.0]);
        assert!(cmft.is_mirror());
    }

    #[test]
    fn other_texts_and_matrices_are_refused() {
        for text in ["", "x", "x y", "x y y", "x y z z", "x y w", "--x y z", "x y - z", "xyz", "x y zé"] {
            assert_eq!(text.parse::<AxisTurn>(), Err(AxisTurnError::Text { found: text.to_owned() }));
        }
        let [a, b, c] = AxisTurn::IDENTITY.rows();
        for rows in [
            [a, a, b],
            [a, b, [0.0; 3]],
            [a, b, [0.0, 1.0, 1.0]],
            [a, b, [0.0, 0.0, f64::NAN]],
            [a, b, [0.0, 0.1, 1.0]],
        ] {
            assert!(matches!(AxisTurn::from_matrix(rows), Err(AxisTurnError::Matrix { .. })), "{rows:?}");
        }
        assert_eq!(AxisTurn::from_matrix([[1.0, 6e-17, 0.0], b, c]), Ok(AxisTurn::IDENTITY));
    }

    #[test]
    fn products_act_in_order_and_inverses_undo() {
        for a in AxisTurn::all() {
            assert_eq!(a.then_after(a.inverse()), AxisTurn::IDENTITY);
            assert_eq!(a.inverse().apply(a.apply(V)), V);
            for b in AxisTurn::all() {
                assert_eq!(a.then_after(b).apply(V), a.apply(b.apply(V)));
            }
        }
    }

    #[test]
    fn rotations_are_those_that_are_no_mirrors() {
        for turn in AxisTurn::all() {
            let Some(rotation) = turn.to_rotation() else {
                assert!(turn.is_mirror());
                continue;
            };
            assert!(!turn.is_mirror());
            for (found, expected) in rotation.rows().iter().flatten().zip(turn.rows().iter().flatten()) {
                assert!((found - expected).abs() < 1e-15, "{turn}");
            }
        }
        // No rounding to keep `resample` from seeing that there is nothing to do.
        assert_eq!(AxisTurn::IDENTITY.to_rotation(), Some(Rotation::IDENTITY));
    }
}
