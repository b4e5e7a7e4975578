//! What a material does where the textbooks differ.

/// What is done about light that bounces more than once between facets, which D·F·G leaves out: 69 % of it at α = 1 and normal view.
///
/// E is the directional albedo for F = 1, E̅ its average, F̅ the average of F.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Compensation {
    /// Nothing: rough metal is too dark.
    None,
    /// The lobe is scaled by 1 + F0 (1 - E(v))/E(v). Not reciprocal. Exact at F0 = 1; one factor a view, so real-time renderers use it.
    ///
    /// E. Turquin, "Practical multiple scattering compensation for microfacet models", 2019, eq. 16.
    Turquin,
    /// A lobe F_ms (1 - E(v)) (1 - E(l)) / (π (1 - E̅)) is added, F_ms = F̅² E̅ / (1 - F̅ (1 - E̅)). Reciprocal.
    ///
    /// C. Kulla and A. Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH course 2017; F̅² after S. Hill,
    /// "A Multi-Faceted Exploration", part 3, 2018.
    #[default]
    KullaConty,
    /// A Lambert lobe of albedo (F0 A + F90 B) F̅ / (1 - F̅ (1 - E(v))) (1 - E(v)) is added. Not reciprocal.
    ///
    /// C. Fdez-Agüera, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", JCGT 8(1), 2019, eq. 15-20.
    FdezAguera,
}

impl Compensation {
    /// Each of them.
    pub const ALL: [Self; 4] = [Self::None, Self::Turquin, Self::KullaConty, Self::FdezAguera];
}

/// How the diffuse lobe, and what passes a thin surface, makes room for the specular lobe. E_s is the directional albedo of the
/// specular lobe with its compensation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DiffuseCoupling {
    /// (1 - E_s(v)) (1 - E_s(l)) / (1 - E̅_s): what is not reflected on the way in comes back through the same surface. Keeps energy,
    /// reciprocal.
    ///
    /// C. Kelemen and L. Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling",
    /// Eurographics short papers 2001.
    #[default]
    Reciprocal,
    /// 1 - E_s(v). Keeps energy, not reciprocal.
    ViewAlbedo,
    /// 1 - F(v·h), the k_d of textbooks and of glTF's appendix B. Reciprocal. A white dielectric returns up to 1.93 times the light at
    /// grazing views, because F(v·h) knows nothing of how flat the view is (test `textbook_couplings_gain_energy`).
    HalfVectorFresnel,
    /// 1 - F_ss, F_ss = F0 + (max(1 - p, F0) - F0)(1 - n·v)⁵: the roughness-aware Fresnel of image-based light (S. Lagarde, "Adopting
    /// a physically based shading model", 2011). Not reciprocal. Right at p = 0; else a white dielectric returns .72 to 1.05 times the
    /// light (same test). Some print F0 + max(1 - p, F0)(1 - n·v)⁵ for F_ss, which exceeds 1.
    RoughnessAwareFresnel,
}

impl DiffuseCoupling {
    /// Each of them.
    pub const ALL: [Self; 4] =
        [Self::Reciprocal, Self::ViewAlbedo, Self::HalfVectorFresnel, Self::RoughnessAwareFresnel];
}
