//! What a push keeps of its skills in a file.

use skills::tool_use::SavedLibrary;

use super::KIND;
use crate::scenario::SavedSkills;

impl SavedSkills for SavedLibrary {
    const TASK: &'static str = KIND.name;
    const HELD: &'static str = "tool";
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/skills/push_stick.toml", include_str!("../../../../../assets/skills/push_stick.toml"));

    fn lines(&self) -> Vec<String> {
        let push = |push: &skills::tool_use::SavedPush| {
            let [x, y] = push.displacement_m.map(|length| 1e3 * length);
            format!("push with `{}`: ({x:.0}, {y:.0}) mm in {:.1} s", push.surface, push.duration_s)
        };
        self.pushes.iter().map(push).collect()
    }

    fn summary(&self) -> String {
        self.pushes.iter().map(|push| push.surface.as_str()).collect::<Vec<_>>().join(" - ")
    }
}
