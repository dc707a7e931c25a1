//! The functions of Embree 4, loaded from the shared library at run time.

use std::env;
use std::ffi::{OsStr, c_char, c_int, c_uint, c_void};
use std::sync::OnceLock;

use libloading::Library;

pub const VARIABLE: &str = "SAHARA_EMBREE";

const NAMES: [&str; 4] = ["libembree4.so.4", "libembree4.so", "libembree4.4.dylib", "embree4.dll"];

pub type Handle = *mut c_void;

/// The first argument is the pointer passed to `rtcSetDeviceErrorFunction`. The other arguments are an error code and a
/// message.
pub type OnError = unsafe extern "C" fn(*mut c_void, c_int, *const c_char);

/// The first argument is the pointer passed to `rtcSetDeviceMemoryMonitorFunction`. The second argument is the change
/// of memory in bytes. The third argument is true if the change has happened. Returns false to refuse the change.
pub type OnMemory = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// The options of a query, passed as `RTCIntersectArguments` or `RTCOccludedArguments`. `flags` and `features` are the
/// first fields of each type. `rest` must be zero.
#[repr(C)]
pub struct Arguments {
    pub flags: c_uint,
    pub features: c_uint,
    pub rest: [usize; 5],
}

// These constants are enumerators in Embree's headers.
pub const TRIANGLES: c_int = 0;
pub const INDICES: c_int = 0;
pub const VERTICES: c_int = 1;
pub const UINT3: c_int = 0x5003;
pub const FLOAT3: c_int = 0x9003;
const VERSION: c_int = 0;

/// The scene flag `RTC_SCENE_FLAG_ROBUST`.
pub const ROBUST: c_int = 4;

macro_rules! api {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions of Embree.
        pub struct Api {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Api {
            /// # Safety
            /// If `library` has these symbols, `library` must be Embree. A function of the result may be called only
            /// if the function in `library` has the declared type.
            unsafe fn find(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: by the contract of this function, the symbols are functions of Embree.
                unsafe { Ok(Self { $($field: *library.get(concat!($symbol, "\0").as_bytes())?,)* }) }
            }
        }
    };
}

api! {
    new_device = "rtcNewDevice": fn(*const c_char) -> Handle;
    release_device = "rtcReleaseDevice": fn(Handle);
    device_error = "rtcGetDeviceError": fn(Handle) -> c_int;
    device_property = "rtcGetDeviceProperty": fn(Handle, c_int) -> isize;
    on_error = "rtcSetDeviceErrorFunction": fn(Handle, OnError, *mut c_void);
    on_memory = "rtcSetDeviceMemoryMonitorFunction": fn(Handle, OnMemory, *mut c_void);
    new_scene = "rtcNewScene": fn(Handle) -> Handle;
    release_scene = "rtcReleaseScene": fn(Handle);
    set_scene_flags = "rtcSetSceneFlags": fn(Handle, c_int);
    set_scene_quality = "rtcSetSceneBuildQuality": fn(Handle, c_int);
    commit_scene = "rtcCommitScene": fn(Handle);
    new_geometry = "rtcNewGeometry": fn(Handle, c_int) -> Handle;
    release_geometry = "rtcReleaseGeometry": fn(Handle);
    new_buffer = "rtcSetNewGeometryBuffer": fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    set_geometry_quality = "rtcSetGeometryBuildQuality": fn(Handle, c_int);
    commit_geometry = "rtcCommitGeometry": fn(Handle);
    attach_geometry = "rtcAttachGeometry": fn(Handle, Handle) -> c_uint;
    intersect1 = "rtcIntersect1": fn(Handle, *mut c_void, *const Arguments);
    occluded1 = "rtcOccluded1": fn(Handle, *mut c_void, *const Arguments);
    intersect8 = "rtcIntersect8": fn(*const c_int, Handle, *mut c_void, *const Arguments);
    occluded8 = "rtcOccluded8": fn(*const c_int, Handle, *mut c_void, *const Arguments);
    intersect16 = "rtcIntersect16": fn(*const c_int, Handle, *mut c_void, *const Arguments);
    occluded16 = "rtcOccluded16": fn(*const c_int, Handle, *mut c_void, *const Arguments);
}

/// The library is never unloaded, because the threads of Embree may outlive devices and scenes.
pub fn api() -> Result<&'static Api, String> {
    static LOADED: OnceLock<Result<(Library, Api), String>> = OnceLock::new();
    LOADED.get_or_init(load).as_ref().map(|(_, api)| api).map_err(String::clone)
}

fn load() -> Result<(Library, Api), String> {
    let named = env::var_os(VARIABLE).filter(|path| !path.is_empty());
    // SAFETY: `Library::new` runs the initialisers of the library. A library that the user names is trusted. The
    // Embree library of the system is trusted.
    let open = |name: &OsStr| unsafe { Library::new(name) };
    let library = match &named {
        Some(path) => open(path)
            .map_err(|error| format!("Embree 4 cannot be loaded from {} ({VARIABLE}): {error}", path.display()))?,
        None => NAMES.iter().find_map(|name| open(name.as_ref()).ok()).ok_or_else(|| {
            format!(
                "Embree 4 is not installed: the system finds no {}; install it, or set {VARIABLE} to the path of the library",
                NAMES[0]
            )
        })?,
    };
    let other = |what: &str| {
        let place = named.as_ref().map_or(NAMES[0].into(), |path| path.display().to_string());
        format!("{place} is not Embree 4: {what}; set {VARIABLE} to the path of libembree4")
    };
    // SAFETY: a library with these symbols is Embree. The functions called here have the same types in Embree 3 and
    // Embree 4.
    let (api, version) = unsafe {
        let api = Api::find(&library).map_err(|error| other(&error.to_string()))?;
        let device = (api.new_device)(c"threads=1".as_ptr());
        let mut version = 0;
        if !device.is_null() {
            version = (api.device_property)(device, VERSION);
            (api.release_device)(device);
        }
        (api, version)
    };
    // Embree 4.4.0 reports the version 40400.
    if version / 10_000 != 4 {
        return Err(other(&format!("its version is {}.{}", version / 10_000, version / 100 % 100)));
    }
    Ok((library, api))
}
