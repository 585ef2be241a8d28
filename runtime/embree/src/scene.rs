//! Scenes: made by a builder, immutable once committed.

use std::ffi::c_void;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::bindings as rtc;
use crate::callbacks::{self, Callbacks, GeometryData};
use crate::device::{Device, EmbreeError};

/// Number of a geometry within its scene, in the order of adding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GeometryId(pub u32);

/// How much time a build may take for faster rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    Low,
    #[default]
    Medium,
    High,
}

/// A scene under construction.
pub struct SceneBuilder<C: Callbacks> {
    scene: Scene<C>,
    count: u32,
}

/// A committed scene.
pub struct Scene<C: Callbacks> {
    pub(crate) raw: rtc::RTCScene,
    pub(crate) device: Device,
    callbacks: Arc<C>,
    /// Boxed because Embree holds their addresses while the list grows.
    #[allow(clippy::vec_box)]
    data: Vec<Box<GeometryData<C>>>,
    /// Scenes that instances refer to.
    instanced: Vec<Arc<Scene<C>>>,
}

// SAFETY: a committed scene is only read; Embree's tracing functions may be called from any thread at once (manual,
// "Scene Object"). `C` is `Send + Sync` by its trait bound, and the raw pointers point to what the scene owns.
unsafe impl<C: Callbacks> Send for Scene<C> {}
// SAFETY: as above.
unsafe impl<C: Callbacks> Sync for Scene<C> {}

impl<C: Callbacks> SceneBuilder<C> {
    /// An empty scene in robust mode (watertight edges).
    pub fn new(device: &Device, callbacks: Arc<C>, quality: BuildQuality) -> Result<SceneBuilder<C>, EmbreeError> {
        // SAFETY: the device is live; the returned scene is released once, by `Scene::drop`.
        let raw = unsafe { rtc::rtcNewScene(device.raw()) };
        device.check()?;
        if raw.is_null() {
            return Err(EmbreeError::Refused("no scene could be made".to_owned()));
        }
        let quality = match quality {
            BuildQuality::Low => rtc::RTCBuildQuality::RTC_BUILD_QUALITY_LOW,
            BuildQuality::Medium => rtc::RTCBuildQuality::RTC_BUILD_QUALITY_MEDIUM,
            BuildQuality::High => rtc::RTCBuildQuality::RTC_BUILD_QUALITY_HIGH,
        };
        // SAFETY: `raw` is a live scene that is not committed.
        unsafe {
            rtc::rtcSetSceneFlags(raw, rtc::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST);
            rtc::rtcSetSceneBuildQuality(raw, quality);
        }
        let scene = Scene { raw, device: device.clone(), callbacks, data: Vec::new(), instanced: Vec::new() };
        Ok(SceneBuilder { scene, count: 0 })
    }

    pub fn callbacks(&self) -> Arc<C> {
        self.scene.callbacks.clone()
    }

    /// User primitives, answered by [`Callbacks`].
    pub fn user_geometry(&mut self, primitives: usize) -> Result<GeometryId, EmbreeError> {
        let count = index_count(primitives)?;
        let geometry = self.geometry(rtc::RTCGeometryType::RTC_GEOMETRY_TYPE_USER)?;
        let id = self.next_id();
        let data = self.data(id);
        // SAFETY: `geometry` is live; `data` is boxed and owned by the scene, which outlives its geometries; the
        // functions are monomorphised for the same `C` that `data` points to.
        unsafe {
            rtc::rtcSetGeometryUserPrimitiveCount(geometry, count);
            rtc::rtcSetGeometryUserData(geometry, data);
            rtc::rtcSetGeometryBoundsFunction(geometry, Some(callbacks::bounds::<C>), std::ptr::null_mut());
            rtc::rtcSetGeometryIntersectFunction(geometry, Some(callbacks::intersect::<C>));
            rtc::rtcSetGeometryOccludedFunction(geometry, Some(callbacks::occluded::<C>));
        }
        self.attach(geometry, id)
    }

    /// Indexed triangles. With `filtered`, each hit is put to [`Callbacks::filter`].
    pub fn triangles(
        &mut self,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        filtered: bool,
    ) -> Result<GeometryId, EmbreeError> {
        self.polygons(rtc::RTCGeometryType::RTC_GEOMETRY_TYPE_TRIANGLE, positions, triangles, filtered)
    }

    /// Indexed quads, each as two triangles (v0 v1 v3) and (v2 v3 v1). With `filtered` as for triangles.
    pub fn quads(
        &mut self,
        positions: &[[f32; 3]],
        quads: &[[u32; 4]],
        filtered: bool,
    ) -> Result<GeometryId, EmbreeError> {
        self.polygons(rtc::RTCGeometryType::RTC_GEOMETRY_TYPE_QUAD, positions, quads, filtered)
    }

    /// A placed copy of a committed scene; `world_from_object` by columns: x, y, z axis and translation.
    pub fn instance(
        &mut self,
        scene: &Arc<Scene<C>>,
        world_from_object: &[[f32; 3]; 4],
    ) -> Result<GeometryId, EmbreeError> {
        if !world_from_object.as_flattened().iter().all(|x| x.is_finite()) {
            return Err(EmbreeError::Invalid("an instance transform that is not finite"));
        }
        if !scene.instanced.is_empty() {
            return Err(EmbreeError::Invalid("an instance of a scene with instances; one level is supported"));
        }
        let geometry = self.geometry(rtc::RTCGeometryType::RTC_GEOMETRY_TYPE_INSTANCE)?;
        let id = self.next_id();
        // SAFETY: both are live; the instanced scene is kept alive by `instanced`; the matrix is twelve floats in
        // column-major order, read during the call.
        unsafe {
            rtc::rtcSetGeometryInstancedScene(geometry, scene.raw);
            rtc::rtcSetGeometryTimeStepCount(geometry, 1);
            rtc::rtcSetGeometryTransform(
                geometry,
                0,
                rtc::RTCFormat::RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                world_from_object.as_ptr() as *const c_void,
            );
        }
        self.scene.instanced.push(scene.clone());
        self.attach(geometry, id)
    }

    /// Builds the hierarchy. Uses Embree's own threads: not to be called from inside a saturated pool.
    pub fn commit(self) -> Result<Scene<C>, EmbreeError> {
        // SAFETY: the scene is live and owned by this builder alone.
        unsafe { rtc::rtcCommitScene(self.scene.raw) };
        self.scene.device.check()?;
        if self.scene.data.iter().any(|data| data.panicked.load(Ordering::Relaxed)) {
            return Err(EmbreeError::Invalid("user geometry whose bounds panicked"));
        }
        Ok(self.scene)
    }

    fn polygons<const N: usize>(
        &mut self,
        kind: rtc::RTCGeometryType,
        positions: &[[f32; 3]],
        indices: &[[u32; N]],
        filtered: bool,
    ) -> Result<GeometryId, EmbreeError> {
        let vertices = index_count(positions.len())?;
        index_count(indices.len())?;
        if indices.as_flattened().iter().any(|&i| i >= vertices) {
            return Err(EmbreeError::Invalid("a vertex index out of range"));
        }
        if !positions.as_flattened().iter().all(|x| x.is_finite()) {
            return Err(EmbreeError::Invalid("a vertex that is not finite"));
        }
        let geometry = self.geometry(kind)?;
        let (format, slot) = match N {
            3 => (rtc::RTCFormat::RTC_FORMAT_UINT3, rtc::RTCBufferType::RTC_BUFFER_TYPE_INDEX),
            _ => (rtc::RTCFormat::RTC_FORMAT_UINT4, rtc::RTCBufferType::RTC_BUFFER_TYPE_INDEX),
        };
        let vertex = rtc::RTCBufferType::RTC_BUFFER_TYPE_VERTEX;
        let filled = fill(geometry, vertex, rtc::RTCFormat::RTC_FORMAT_FLOAT3, positions)
            && fill(geometry, slot, format, indices);
        if !filled {
            // SAFETY: the geometry is live and given up here.
            unsafe { rtc::rtcReleaseGeometry(geometry) };
            self.scene.device.check()?;
            return Err(EmbreeError::OutOfMemory("a vertex or index buffer".to_owned()));
        }
        let id = self.next_id();
        if filtered {
            let data = self.data(id);
            // SAFETY: as in `user_geometry`.
            unsafe {
                rtc::rtcSetGeometryUserData(geometry, data);
                rtc::rtcSetGeometryIntersectFilterFunction(geometry, Some(callbacks::filter::<C>));
                rtc::rtcSetGeometryOccludedFilterFunction(geometry, Some(callbacks::filter_occluded::<C>));
            }
        }
        self.attach(geometry, id)
    }

    fn geometry(&self, kind: rtc::RTCGeometryType) -> Result<rtc::RTCGeometry, EmbreeError> {
        // SAFETY: the device is live; the geometry is released by `attach` once the scene holds it.
        let geometry = unsafe { rtc::rtcNewGeometry(self.scene.device.raw(), kind) };
        self.scene.device.check()?;
        if geometry.is_null() {
            return Err(EmbreeError::Refused("no geometry could be made".to_owned()));
        }
        Ok(geometry)
    }

    fn next_id(&mut self) -> GeometryId {
        self.count += 1;
        GeometryId(self.count - 1)
    }

    fn data(&mut self, id: GeometryId) -> *mut c_void {
        let callbacks = Arc::as_ptr(&self.scene.callbacks);
        let data = Box::new(GeometryData { id, callbacks, panicked: AtomicBool::new(false) });
        let pointer = data.user_pointer();
        self.scene.data.push(data);
        pointer
    }

    fn attach(&mut self, geometry: rtc::RTCGeometry, id: GeometryId) -> Result<GeometryId, EmbreeError> {
        // SAFETY: geometry and scene are live; attaching takes a reference, so ours is released. Ids are given out in
        // order, each once.
        unsafe {
            rtc::rtcCommitGeometry(geometry);
            rtc::rtcAttachGeometryByID(self.scene.raw, geometry, id.0);
            rtc::rtcReleaseGeometry(geometry);
        }
        self.scene.device.check()?;
        Ok(id)
    }
}

impl<C: Callbacks> Scene<C> {
    pub fn callbacks(&self) -> &C {
        &self.callbacks
    }
}

impl<C: Callbacks> Drop for Scene<C> {
    fn drop(&mut self) {
        // SAFETY: `raw` is live and released here once, before the data that its geometries point to.
        unsafe { rtc::rtcReleaseScene(self.raw) };
    }
}

/// Embree counts in 32 bits and keeps the last number for "none".
fn index_count(len: usize) -> Result<u32, EmbreeError> {
    u32::try_from(len)
        .ok()
        .filter(|&n| n < u32::MAX)
        .ok_or(EmbreeError::Invalid("more than 2^32 - 2 primitives or vertices in one geometry"))
}

/// Allocates a buffer of the geometry and copies `items` into it. False when there is no memory.
fn fill<T: Copy, const N: usize>(
    geometry: rtc::RTCGeometry,
    slot: rtc::RTCBufferType,
    format: rtc::RTCFormat,
    items: &[[T; N]],
) -> bool {
    if items.is_empty() {
        return true;
    }
    let stride = size_of::<[T; N]>();
    // SAFETY: the geometry is live; Embree gives room for `items.len()` elements of `stride` bytes (padded by itself),
    // or null; the source has just as many plain elements, and the ranges cannot overlap.
    unsafe {
        let buffer = rtc::rtcSetNewGeometryBuffer(geometry, slot, 0, format, stride, items.len());
        if buffer.is_null() {
            return false;
        }
        std::ptr::copy_nonoverlapping(items.as_ptr(), buffer as *mut [T; N], items.len());
    }
    true
}
