use std::time::Duration;

use glam::Vec3;

use super::*;
use crate::scene::load;

#[test]
fn seconds_are_finite_and_not_negative() {
    assert_eq!(["0.001", "2", "1e-7"].map(nanoseconds), [1_000_000, 2_000_000_000, 100].map(Some));
    for wrong in ["nan", "inf", "-0.5", "1e300", "", "1 s"] {
        assert_eq!(nanoseconds(wrong), None, "{wrong}");
    }
}

#[test]
fn a_program_is_called_by_its_file_and_arguments() {
    let name = |command: &str| Program::new(command, Duration::from_secs(10)).map(|program| program.name());
    let echo = "sh -c 'echo runner 1 closest any; cat > /dev/null'";
    assert_eq!(name(&format!("/bin/{echo}")).unwrap(), "sh -c echo runner 1 closest any; cat > /dev/null");
    assert!(name("'").unwrap_err().contains("quote arguments"));
    assert!(name("sh -c 'echo runner 2 closest'").unwrap_err().contains("runner 1 closest any"));
}

#[test]
fn a_mesh_is_written_as_it_is_read() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.1, -2.5e-30, 3e7), Vec3::Y];
    let mesh = Mesh::new(positions, vec![[0, 1, 2], [2, 2, 3], [3, 0, 1]]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.ply");
    std::fs::write(&path, mesh_bytes(&mesh)).unwrap();
    let read = load(&path).unwrap();
    assert_eq!((&read.positions[..], &read.triangles[..]), (mesh.positions(), mesh.triangles()));
    let bytes = std::fs::read(&path).unwrap();
    let (header, body) = bytes.split_at(bytes.len() - 4 * 12 - 3 * 13);
    let header = String::from_utf8(header.into()).unwrap();
    // The document shows each line of the header in backquotes.
    let document = include_str!("../images/scene/files/FORMAT.md");
    for line in header.lines() {
        let line = line.replace("vertex 4", "vertex N").replace("face 3", "face M");
        assert!(document.split_whitespace().collect::<Vec<_>>().join(" ").contains(&format!("`{line}`")), "{line}");
    }
    assert!(header.ends_with("end_header\n") && body[48] == 3);
}
