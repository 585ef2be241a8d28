//! The device: errors and memory.

use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::bindings as rtc;

/// What Embree complained about.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EmbreeError {
    #[error("Embree ran out of memory: {0}")]
    OutOfMemory(String),
    #[error("this processor is not supported by Embree: {0}")]
    UnsupportedCpu(String),
    #[error("Embree refused the call: {0}")]
    Refused(String),
    #[error("Embree was given {0}")]
    Invalid(&'static str),
}

/// What the callbacks of one device write to. Boxed behind an `Arc`, so that its address is stable.
#[derive(Default)]
struct DeviceState {
    /// The first error since the last look.
    error: Mutex<Option<EmbreeError>>,
    bytes: AtomicIsize,
    peak_bytes: AtomicIsize,
}

/// An Embree device. Cheap to clone; released when the last clone and the last scene are gone.
#[derive(Clone)]
pub struct Device {
    inner: Arc<RawDevice>,
}

struct RawDevice {
    raw: rtc::RTCDevice,
    state: Box<DeviceState>,
}

// SAFETY: Embree's device functions are thread-safe by its manual (API, "Device Object"); the state behind the
// callbacks is made of a mutex and atomics.
unsafe impl Send for RawDevice {}
// SAFETY: as above.
unsafe impl Sync for RawDevice {}

impl Device {
    /// A device with this many build threads; 0 leaves the choice to Embree.
    pub fn new(threads: usize) -> Result<Device, EmbreeError> {
        let config = CString::new(format!("threads={threads}")).unwrap_or_default();
        // SAFETY: `config` is a NUL-terminated string that outlives the call.
        let raw = unsafe { rtc::rtcNewDevice(config.as_ptr()) };
        if raw.is_null() {
            // SAFETY: a null device asks for the calling thread's error of the failed creation.
            let code = unsafe { rtc::rtcGetDeviceError(std::ptr::null_mut()) };
            return Err(error_of(code, "no device could be made".to_owned()));
        }
        let state = Box::<DeviceState>::default();
        let pointer = &*state as *const DeviceState as *mut c_void;
        // SAFETY: `raw` is a live device. `pointer` stays valid until the device is released, because `RawDevice`
        // owns the box and its `drop` unregisters both callbacks before the box goes.
        unsafe {
            rtc::rtcSetDeviceErrorFunction(raw, Some(on_error), pointer);
            rtc::rtcSetDeviceMemoryMonitorFunction(raw, Some(on_memory), pointer);
        }
        Ok(Device { inner: Arc::new(RawDevice { raw, state }) })
    }

    /// Bytes that Embree holds now for this device.
    pub fn bytes(&self) -> usize {
        self.inner.state.bytes.load(Ordering::Relaxed).max(0) as usize
    }

    /// The most bytes that Embree held at once for this device.
    pub fn peak_bytes(&self) -> usize {
        self.inner.state.peak_bytes.load(Ordering::Relaxed).max(0) as usize
    }

    pub(crate) fn raw(&self) -> rtc::RTCDevice {
        self.inner.raw
    }

    /// The first error since the last call, if any.
    pub(crate) fn check(&self) -> Result<(), EmbreeError> {
        match self.inner.state.error.lock().unwrap_or_else(PoisonError::into_inner).take() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }
}

impl Drop for RawDevice {
    fn drop(&mut self) {
        // SAFETY: `raw` is live and released here once. Scenes hold a clone of the `Arc`, so none is left. The
        // callbacks are unregistered first: nothing points to `state` when it is dropped after this.
        unsafe {
            rtc::rtcSetDeviceErrorFunction(self.raw, None, std::ptr::null_mut());
            rtc::rtcSetDeviceMemoryMonitorFunction(self.raw, None, std::ptr::null_mut());
            rtc::rtcReleaseDevice(self.raw);
        }
    }
}

fn error_of(code: rtc::RTCError, text: String) -> EmbreeError {
    match code {
        rtc::RTCError::RTC_ERROR_OUT_OF_MEMORY => EmbreeError::OutOfMemory(text),
        rtc::RTCError::RTC_ERROR_UNSUPPORTED_CPU => EmbreeError::UnsupportedCpu(text),
        _ => EmbreeError::Refused(text),
    }
}

unsafe extern "C" fn on_error(state: *mut c_void, code: rtc::RTCError, text: *const c_char) {
    // SAFETY: Embree hands back the pointer that was registered with this function: a live `DeviceState`.
    let state = unsafe { &*(state as *const DeviceState) };
    let text = if text.is_null() {
        String::new()
    } else {
        // SAFETY: Embree passes a NUL-terminated message that lives for the call.
        unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
    };
    state.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error_of(code, text));
}

unsafe extern "C" fn on_memory(state: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: as in `on_error`.
    let state = unsafe { &*(state as *const DeviceState) };
    let now = state.bytes.fetch_add(bytes, Ordering::Relaxed) + bytes;
    state.peak_bytes.fetch_max(now, Ordering::Relaxed);
    true
}
