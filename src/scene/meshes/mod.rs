//! Meshes made by our own code.
