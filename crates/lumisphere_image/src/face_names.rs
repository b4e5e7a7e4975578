//! Which face of a cube a file holds, by its name.

/// A way of naming the six files of a cube. Order of the names: +X -X +Y -Y +Z -Z.
///
/// Which wall of the world a name shows depends on [`FaceSide`](crate::FaceSide), which names do not tell; only the face
/// of the cube table is in the name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceNaming {
    /// `px nx py ny pz nz` (three.js, cmgen).
    Short,
    /// `posx negx posy negy posz negz` (Humus' skyboxes, cmft).
    Long,
    /// `+x -x +y -y +z -z`.
    Signed,
    /// `right left top bottom front back`; `up` and `down` are read too. Front is +Z and back -Z: skybox tutorials hand
    /// the six to OpenGL in this order, and with right at +X it is the only choice in which pictures that look right
    /// from inside ([`FaceSide::FromInside`](crate::FaceSide::FromInside)) meet their neighbours.
    Words,
    /// `r l u d f b`, the first letters of the words, after an underscore.
    Letters,
    /// `face0` to `face5`.
    FaceNumbers,
    /// `0` to `5` after an underscore.
    Numbers,
    /// `c00` to `c05` after an underscore (cubes cut up for Unreal).
    CNumbers,
}

/// What the name of a face's file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceName<'a> {
    /// What comes before the face's own name, the separator included; may be empty. Files of one set share it.
    pub prefix: &'a str,
    /// 0 to 5 for +X -X +Y -Y +Z -Z.
    pub face: usize,
    /// The way of naming. Files of one set share it.
    pub naming: FaceNaming,
}

/// What must come before a face's name, so that `bright` is not a right face.
#[derive(Clone, Copy, PartialEq)]
enum Before {
    Anything,
    /// Nothing, or a character that is neither letter nor digit.
    NoWord,
    Underscore,
}

/// Other words for faces.
const SYNONYMS: [(&str, usize); 2] = [("up", 2), ("down", 3)];

impl FaceNaming {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Long,
        Self::Short,
        Self::Signed,
        Self::Words,
        Self::FaceNumbers,
        Self::CNumbers,
        Self::Letters,
        Self::Numbers,
    ];

    /// The six names, in lower case and without a separator.
    pub fn names(self) -> [&'static str; 6] {
        match self {
            Self::Short => ["px", "nx", "py", "ny", "pz", "nz"],
            Self::Long => ["posx", "negx", "posy", "negy", "posz", "negz"],
            Self::Signed => ["+x", "-x", "+y", "-y", "+z", "-z"],
            Self::Words => ["right", "left", "top", "bottom", "front", "back"],
            Self::Letters => ["r", "l", "u", "d", "f", "b"],
            Self::FaceNumbers => ["face0", "face1", "face2", "face3", "face4", "face5"],
            Self::Numbers => ["0", "1", "2", "3", "4", "5"],
            Self::CNumbers => ["c00", "c01", "c02", "c03", "c04", "c05"],
        }
    }

    fn before(self) -> Before {
        match self {
            Self::Signed => Before::Anything,
            Self::Short | Self::Long | Self::Words | Self::FaceNumbers => Before::NoWord,
            Self::Letters | Self::Numbers | Self::CNumbers => Before::Underscore,
        }
    }

    /// What comes before the face's name and the face, if the stem ends in one of these names.
    fn read(self, stem: &str) -> Option<(&str, usize)> {
        let synonyms = if self == Self::Words { &SYNONYMS[..] } else { &[] };
        let mut names = self.names().into_iter().zip(0..).chain(synonyms.iter().copied());
        let (prefix, face) = names.find_map(|(name, face)| Some((without_ending(stem, name)?, face)))?;
        let fits = match self.before() {
            Before::Anything => true,
            Before::NoWord => !prefix.ends_with(char::is_alphanumeric),
            Before::Underscore => prefix.ends_with('_'),
        };
        fits.then_some((prefix, face))
    }
}

/// The face that a file's name without its ending names, or `None`. Capitals count as small letters.
///
/// One file proves nothing (`shot_3` is a face by this rule): a set is six files with one prefix and naming.
///
/// ```
/// use lumisphere_image::{FaceNaming, face_of_name};
///
/// let found = face_of_name("park_NegZ").map(|name| (name.prefix, name.face, name.naming));
/// assert_eq!(found, Some(("park_", 5, FaceNaming::Long)));
/// assert_eq!(face_of_name("bright"), None);
/// ```
pub fn face_of_name(stem: &str) -> Option<FaceName<'_>> {
    FaceNaming::ALL.into_iter().find_map(|naming| {
        let (prefix, face) = naming.read(stem)?;
        Some(FaceName { prefix, face, naming })
    })
}

fn without_ending<'a>(stem: &'a str, ending: &str) -> Option<&'a str> {
    let (prefix, end) = stem.split_at_checked(stem.len().checked_sub(ending.len())?)?;
    end.eq_ignore_ascii_case(ending).then_some(prefix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_found_in_the_order_of_the_faces() {
        for (naming, prefix, stems) in [
            (FaceNaming::Short, "", ["px", "nx", "py", "ny", "pz", "nz"]),
            (FaceNaming::Short, "sky-", ["sky-PX", "sky-NX", "sky-PY", "sky-NY", "sky-PZ", "sky-NZ"]),
            (FaceNaming::Long, "a_", ["a_posx", "a_negx", "a_posy", "a_negy", "a_posz", "a_negz"]),
            (FaceNaming::Signed, "cube", ["cube+x", "cube-x", "cube+y", "cube-y", "cube+z", "cube-z"]),
            (FaceNaming::Words, "", ["right", "left", "top", "bottom", "front", "back"]),
            (FaceNaming::Words, "é ", ["é Right", "é Left", "é Up", "é Down", "é Front", "é Back"]),
            (FaceNaming::Letters, "sky_", ["sky_r", "sky_l", "sky_u", "sky_d", "sky_f", "sky_b"]),
            (FaceNaming::FaceNumbers, "", ["face0", "face1", "face2", "face3", "face4", "face5"]),
            (FaceNaming::Numbers, "face_", ["face_0", "face_1", "face_2", "face_3", "face_4", "face_5"]),
            (FaceNaming::CNumbers, "m_", ["m_c00", "m_c01", "m_c02", "m_c03", "m_c04", "m_c05"]),
        ] {
            for (face, stem) in stems.into_iter().enumerate() {
                assert_eq!(face_of_name(stem), Some(FaceName { prefix, face, naming }), "{stem}");
            }
        }
    }

    #[test]
    fn other_names_name_no_face() {
        for stem in [
            "", "bright", "backup", "laptop", "alpx", "r", "0", "sky-r", "shot3", "face6", "sky_6", "c00", "_c06", "é",
            "x",
        ] {
            assert_eq!(face_of_name(stem), None, "{stem}");
        }
    }

    #[test]
    fn names_for_writing_are_read_back() {
        for naming in FaceNaming::ALL {
            let prefix = if naming.before() == Before::Underscore { "out_" } else { "" };
            for (face, name) in naming.names().into_iter().enumerate() {
                let stem = format!("{prefix}{name}");
                assert_eq!(face_of_name(&stem), Some(FaceName { prefix, face, naming }), "{stem}");
            }
        }
    }
}
