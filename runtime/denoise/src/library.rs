//! The functions of the shared library, and objects that release what they own.
//!
//! Signatures are those of `oidn.h`, version 2. Handles are opaque pointers, never followed here.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;

use crate::{DenoiseError, Features, NAMES};

type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`
const PROCESSOR: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`
const FLOAT3: c_int = 3;

type SetImage = unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);

/// Copies of the library's function pointers; `code` keeps them valid.
pub struct Library {
    new_device: unsafe extern "C" fn(c_int) -> Handle,
    commit_device: unsafe extern "C" fn(Handle),
    release_device: unsafe extern "C" fn(Handle),
    device_error: unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int,
    new_filter: unsafe extern "C" fn(Handle, *const c_char) -> Handle,
    set_image: SetImage,
    set_flag: unsafe extern "C" fn(Handle, *const c_char, bool),
    commit_filter: unsafe extern "C" fn(Handle),
    execute_filter: unsafe extern "C" fn(Handle),
    release_filter: unsafe extern "C" fn(Handle),
    _code: libloading::Library,
}

/// A committed device; released when dropped.
pub struct Device {
    handle: Handle,
    release: unsafe extern "C" fn(Handle),
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the handle came from `oidnNewDevice`, is not null and is released once, here. The library is still
        // loaded: `Denoiser` drops its device first.
        unsafe { (self.release)(self.handle) }
    }
}

/// A filter; released when dropped.
struct Filter<'a> {
    handle: Handle,
    library: &'a Library,
}

impl Drop for Filter<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle came from `oidnNewFilter`, is not null and is released once, here.
        unsafe { (self.library.release_filter)(self.handle) }
    }
}

impl Library {
    pub fn load(path: Option<&Path>) -> Result<Library, DenoiseError> {
        let Some(path) = path else {
            let found = NAMES.iter().find_map(|name| open(Path::new(name)).ok());
            return Library::bind(found.ok_or(DenoiseError::Missing)?, Path::new(NAMES[0]));
        };
        let failed = |source: libloading::Error| DenoiseError::Load { path: path.to_owned(), source: Box::new(source) };
        Library::bind(open(path).map_err(failed)?, path)
    }

    fn bind(code: libloading::Library, path: &Path) -> Result<Library, DenoiseError> {
        /// The function called `name`.
        ///
        /// # Safety
        /// The function of that name must have the type `F`.
        unsafe fn function<F: Copy>(code: &libloading::Library, name: &CStr) -> Result<F, libloading::Error> {
            // SAFETY: the caller vouches for the type.
            unsafe { code.get::<F>(name.to_bytes_with_nul()).map(|symbol| *symbol) }
        }
        let bound = || -> Result<_, libloading::Error> {
            // SAFETY: the types of the fields are the signatures of these functions in `oidn.h` of version 2, which is
            // checked by `oidnSetFilterBool` being there: version 1 calls it otherwise.
            unsafe {
                Ok((
                    (
                        function(&code, c"oidnNewDevice")?,
                        function(&code, c"oidnCommitDevice")?,
                        function(&code, c"oidnReleaseDevice")?,
                        function(&code, c"oidnGetDeviceError")?,
                        function(&code, c"oidnNewFilter")?,
                    ),
                    (
                        function(&code, c"oidnSetSharedFilterImage")?,
                        function(&code, c"oidnSetFilterBool")?,
                        function(&code, c"oidnCommitFilter")?,
                        function(&code, c"oidnExecuteFilter")?,
                        function(&code, c"oidnReleaseFilter")?,
                    ),
                ))
            }
        };
        let ((new_device, commit_device, release_device, device_error, new_filter), filters) =
            bound().map_err(|source| DenoiseError::Load { path: path.to_owned(), source: Box::new(source) })?;
        let (set_image, set_flag, commit_filter, execute_filter, release_filter) = filters;
        Ok(Library {
            new_device,
            commit_device,
            release_device,
            device_error,
            new_filter,
            set_image,
            set_flag,
            commit_filter,
            execute_filter,
            release_filter,
            _code: code,
        })
    }

    pub fn device(&self) -> Result<Device, DenoiseError> {
        // SAFETY: the argument is a constant of `oidn.h`.
        let handle = unsafe { (self.new_device)(PROCESSOR) };
        if handle.is_null() {
            return Err(self.error(ptr::null_mut()).unwrap_or_else(|| DenoiseError::Library("no device".into())));
        }
        let device = Device { handle, release: self.release_device };
        // SAFETY: the handle is a device that lives as long as `device`.
        unsafe { (self.commit_device)(device.handle) };
        match self.error(device.handle) {
            Some(error) => Err(error),
            None => Ok(device),
        }
    }

    /// All buffers hold `size[0] * size[1]` pixels, which [`crate::Denoiser`] has checked.
    pub fn run(
        &self,
        device: &Device,
        size: [usize; 2],
        light: &[[f32; 3]],
        features: Features<'_>,
    ) -> Result<Vec<[f32; 3]>, DenoiseError> {
        let mut result = vec![[0.0f32; 3]; light.len()];
        // SAFETY: the device is alive, the name is a C string.
        let handle = unsafe { (self.new_filter)(device.handle, c"RT".as_ptr()) };
        if handle.is_null() {
            let error = self.error(device.handle);
            return Err(error.unwrap_or_else(|| DenoiseError::Library("it has no filter for light".into())));
        }
        let filter = Filter { handle, library: self };
        self.input(&filter, c"color", light, size);
        if let Some(albedo) = features.albedo {
            self.input(&filter, c"albedo", albedo, size);
            if let Some(normal) = features.normal {
                self.input(&filter, c"normal", normal, size);
            }
        }
        // SAFETY: the filter is alive and the names are C strings. `result` has a `FLOAT3` for each pixel, rows without
        // gaps (strides of 0 say so), and is neither moved nor touched before the filter has run, below; the inputs are
        // borrowed until then. Execution is synchronous: when it returns, no pointer is used any more.
        unsafe {
            let pixels = result.as_mut_ptr().cast();
            (self.set_image)(filter.handle, c"output".as_ptr(), pixels, FLOAT3, size[0], size[1], 0, 0, 0);
            (self.set_flag)(filter.handle, c"hdr".as_ptr(), true);
            (self.commit_filter)(filter.handle);
            (self.execute_filter)(filter.handle);
        }
        drop(filter);
        match self.error(device.handle) {
            Some(error) => Err(error),
            None => Ok(result),
        }
    }

    fn input(&self, filter: &Filter<'_>, name: &CStr, pixels: &[[f32; 3]], size: [usize; 2]) {
        // SAFETY: as for the output in `run`; the library only reads inputs, so that the pointer may come from a shared
        // borrow.
        unsafe {
            let pixels = pixels.as_ptr().cast_mut().cast();
            (self.set_image)(filter.handle, name.as_ptr(), pixels, FLOAT3, size[0], size[1], 0, 0, 0);
        }
    }

    /// Takes the error of a device, or of the thread for a null handle.
    fn error(&self, device: Handle) -> Option<DenoiseError> {
        let mut message: *const c_char = ptr::null();
        // SAFETY: the device is alive or null, which is allowed; the message is written to a place of ours.
        let code = unsafe { (self.device_error)(device, &mut message) };
        if code == 0 {
            return None;
        }
        if message.is_null() {
            return Some(DenoiseError::Library(format!("error {code}")));
        }
        // SAFETY: the library gives a C string that stays until its next error; it is copied at once.
        let text = unsafe { CStr::from_ptr(message) };
        Some(DenoiseError::Library(text.to_string_lossy().into_owned()))
    }
}

fn open(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: running the initialisers of a library is what the caller of `Denoiser::load` asks for, who is told so.
    unsafe { libloading::Library::new(path) }
}
