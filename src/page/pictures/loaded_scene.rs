//! A scene of the runs.

use crate::escaped::quoted;
use crate::request::SceneRequest;
use crate::scene::Scene;

pub struct LoadedScene {
    pub scene: Scene,
    pub request: SceneRequest,
}

impl LoadedScene {
    /// The scene and its view as arguments for a shell.
    pub fn words(&self) -> String {
        let view = self.request.view.words();
        [quoted(&self.request.word), view].into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
    }

    /// The cube with another name, loaded by `word` and with the view in the JSON `view`.
    #[cfg(test)]
    pub fn cube(word: &str, name: &str, view: &str) -> Self {
        let scene = Scene { name: name.into(), ..crate::scene::Builtin::find("cube").unwrap().scene(None).unwrap() };
        let request = SceneRequest::new(word, &serde_json::from_str(view).unwrap(), &scene);
        Self { scene, request }
    }
}
