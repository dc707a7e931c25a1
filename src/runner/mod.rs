//! A runner is an external program that builds a structure, traces rays and measures the times.
//! [`crate::scene::files`] documents the protocol.

mod program;
mod ray_set;
mod session;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::sync::Mutex;

use tempfile::TempDir;

use self::ray_set::{RaySet, State, locked};
use self::session::{nanoseconds, unexpected};
use crate::accel::{BuildError, Capabilities, Counts, DynAccel, Footprint, Loaded, Observed, Remote, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::median;
use crate::scene::files::mesh_bytes;

pub use program::Program;

pub struct Runner {
    state: Mutex<State>,
    /// The folder of the scene, ray and hit files.
    folder: TempDir,
    capabilities: Capabilities,
    build_ns: u64,
    bytes: usize,
    triangles: usize,
}

impl Runner {
    pub fn build(program: &Program, mesh: &Mesh) -> Result<Self, BuildError> {
        Self::begin(program, mesh).map_err(BuildError::Remote)
    }

    fn begin(program: &Program, mesh: &Mesh) -> Result<Self, String> {
        let (mut session, capabilities) = program.start(rayon::current_num_threads())?;
        let folder = tempfile::Builder::new().prefix("sahara-runner-").tempdir();
        let folder = folder.map_err(|cause| format!("cannot create a folder for its files: {cause}"))?;
        let path = folder.path().join("scene.ply");
        std::fs::write(&path, mesh_bytes(mesh)).map_err(|cause| format!("cannot write {}: {cause}", path.display()))?;
        let (request, form) = (format!("scene {}", path.display()), "built SECONDS BYTES");
        let reply = session.request(&request)?.text;
        let read = || {
            let (seconds, bytes) = reply.strip_prefix("built ")?.split_once(' ')?;
            Some((nanoseconds(seconds)?, bytes.parse().ok()?))
        };
        let (build_ns, bytes) = read().ok_or_else(|| unexpected(&request, &reply, form))?;
        let _ = std::fs::remove_file(path);
        let state = State { session, failure: None, taken: vec![], outside: vec![] };
        Ok(Self { state: Mutex::new(state), folder, capabilities, build_ns, bytes, triangles: mesh.len() })
    }
}

impl Remote for Runner {
    fn build_ns(&self) -> u64 {
        self.build_ns
    }

    fn failure(&self) -> Option<String> {
        locked(&self.state).failure.clone()
    }

    fn outside(&self) -> Option<f64> {
        median(&locked(&self.state).outside)
    }
}

impl DynAccel for Runner {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.load(Cow::Borrowed(rays)).closest_hits(hits);
    }

    fn any_hits(&self, rays: &[Ray], hits: &mut [bool]) {
        self.load(Cow::Borrowed(rays)).any_hits(hits);
    }

    fn closest_hits_counted(&self, rays: &[Ray], hits: &mut [Option<Hit>], _: &mut Counts) {
        DynAccel::closest_hits(self, rays, hits);
    }

    fn any_hits_counted(&self, rays: &[Ray], hits: &mut [bool], _: &mut Counts) {
        DynAccel::any_hits(self, rays, hits);
    }

    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(RaySet::new(&self.state, self.folder.path(), rays))
    }

    fn observed(&self) -> Observed {
        Observed::NONE
    }

    fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    fn footprint(&self) -> Footprint {
        Footprint { other: self.bytes, ..Footprint::default() }
    }

    /// One leaf with all triangles represents the unknown shape.
    fn shape(&self) -> TreeShape {
        TreeShape { leaves: 1, references: self.triangles, largest_leaf: self.triangles, ..TreeShape::default() }
    }

    fn remote(&self) -> Option<&dyn Remote> {
        Some(self)
    }
}
