//! As much of Embree 4 as is needed, by its C interface (`embree4/rtcore.h`).

use anyhow::{Context, Result, ensure};
use libloading::Library;
use lumisphere_trace::rays::{Hit, Ray};
use std::ffi::{CString, c_char, c_void};

type Handle = *mut c_void;
type Intersect = unsafe extern "C" fn(Handle, *mut RayHit, *const c_void);
type Occluded = unsafe extern "C" fn(Handle, *mut RtcRay, *const c_void);

const INVALID: u32 = u32::MAX;
const TYPE_TRIANGLE: u32 = 0;
const BUFFER_INDEX: u32 = 0;
const BUFFER_VERTEX: u32 = 1;
const FORMAT_UINT3: u32 = 0x5003;
const FORMAT_FLOAT3: u32 = 0x9003;
const FLAG_ROBUST: u32 = 4;
const PROPERTY_VERSION: u32 = 0;

/// `RTCRay`
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RtcRay {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCRayHit`
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RayHit {
    ray: RtcRay,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instance: [u32; 2],
}

/// Which triangle test Embree uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Robustness {
    /// Its default.
    Fast,
    /// `RTC_SCENE_FLAG_ROBUST`: watertight at edges.
    Robust,
}

pub(crate) struct Embree {
    scene: Handle,
    intersect: Intersect,
    occluded: Occluded,
    pub(crate) version: isize,
    _buffers: (Vec<[f32; 3]>, Vec<[u32; 3]>),
}

impl Embree {
    pub(crate) fn build(
        path: &str,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        robustness: Robustness,
    ) -> Result<Self> {
        let mut padded = positions.to_vec();
        padded.extend([[0.0; 3]; 2]); // Embree reads 16 bytes a vertex
        let triangles = triangles.to_vec();
        let config = CString::new("threads=1")?;
        // SAFETY: the signatures are those of rtcore.h 4; the buffers live as long as the scene.
        unsafe {
            let library = Library::new(path).with_context(|| format!("cannot open {path}"))?;
            let new_device = library.get::<unsafe extern "C" fn(*const c_char) -> Handle>(b"rtcNewDevice")?;
            let property = library.get::<unsafe extern "C" fn(Handle, u32) -> isize>(b"rtcGetDeviceProperty")?;
            let error = library.get::<unsafe extern "C" fn(Handle) -> u32>(b"rtcGetDeviceError")?;
            let new_scene = library.get::<unsafe extern "C" fn(Handle) -> Handle>(b"rtcNewScene")?;
            let flags = library.get::<unsafe extern "C" fn(Handle, u32)>(b"rtcSetSceneFlags")?;
            let new_geometry = library.get::<unsafe extern "C" fn(Handle, u32) -> Handle>(b"rtcNewGeometry")?;
            type SetBuffer = unsafe extern "C" fn(Handle, u32, u32, u32, *const c_void, usize, usize, usize);
            let buffer = library.get::<SetBuffer>(b"rtcSetSharedGeometryBuffer")?;
            let commit_geometry = library.get::<unsafe extern "C" fn(Handle)>(b"rtcCommitGeometry")?;
            let attach = library.get::<unsafe extern "C" fn(Handle, Handle) -> u32>(b"rtcAttachGeometry")?;
            let commit_scene = library.get::<unsafe extern "C" fn(Handle)>(b"rtcCommitScene")?;
            let intersect = *library.get::<Intersect>(b"rtcIntersect1")?;
            let occluded = *library.get::<Occluded>(b"rtcOccluded1")?;
            let device = new_device(config.as_ptr());
            ensure!(!device.is_null(), "Embree made no device");
            let scene = new_scene(device);
            if robustness == Robustness::Robust {
                flags(scene, FLAG_ROBUST);
            }
            let geometry = new_geometry(device, TYPE_TRIANGLE);
            buffer(geometry, BUFFER_VERTEX, 0, FORMAT_FLOAT3, padded.as_ptr().cast(), 0, 12, positions.len());
            buffer(geometry, BUFFER_INDEX, 0, FORMAT_UINT3, triangles.as_ptr().cast(), 0, 12, triangles.len());
            commit_geometry(geometry);
            attach(scene, geometry);
            commit_scene(scene);
            let code = error(device);
            ensure!(code == 0, "Embree reports error {code}");
            let version = property(device, PROPERTY_VERSION);
            // Its threads may still run when the process ends.
            std::mem::forget(library);
            Ok(Self { scene, intersect, occluded, version, _buffers: (padded, triangles) })
        }
    }

    pub(crate) fn closest_hit(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        let mut query = RayHit {
            ray: RtcRay::new(ray, t_max),
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: INVALID,
            geometry: INVALID,
            instance: [INVALID; 2],
        };
        // SAFETY: the scene is committed; the query has the layout of `RTCRayHit`.
        unsafe { (self.intersect)(self.scene, &mut query, std::ptr::null()) };
        let hit = Hit { t: query.ray.t_far, triangle: query.primitive, u: query.u, v: query.v };
        (query.geometry != INVALID).then_some(hit)
    }

    pub(crate) fn occluded(&self, ray: &Ray, t_max: f32) -> bool {
        let mut query = RtcRay::new(ray, t_max);
        // SAFETY: the scene is committed; the query has the layout of `RTCRay`.
        unsafe { (self.occluded)(self.scene, &mut query, std::ptr::null()) };
        query.t_far < 0.0
    }
}

impl RtcRay {
    fn new(ray: &Ray, t_max: f32) -> Self {
        let Ray { origin, direction } = *ray;
        Self { origin, t_near: 0.0, direction, time: 0.0, t_far: t_max, mask: u32::MAX, id: 0, flags: 0 }
    }
}
