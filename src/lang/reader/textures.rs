//! Reads the images of textures.

use super::check::{Check, Source, place_of};
use super::fault::{Fault, Severity};
use super::misplaced;
use std::collections::BTreeSet;
use tabray_core::scene::store::Store;
use tabray_core::scene::value::Datum;

impl Check<'_, '_> {
    /// Reads only the textures that entities refer to.
    pub fn textures_can_be_read(&mut self, store: &Store, source: &Source<'_, '_>) {
        if self.textures.is_empty() {
            return;
        }
        let users =
            self.objects.iter().map(|object| &object.args).chain(self.lights.iter().map(|light| &light.args));
        let users = users.chain(self.patterns.iter().map(|pattern| &pattern.args));
        let (mut used, mut memory) = (BTreeSet::new(), None);
        for user in users {
            used.extend(user.args_in(&mut memory).textures().map(str::to_owned));
        }
        for (order, _) in &self.shaders {
            used.extend(store.args(*order).textures().map(str::to_owned));
        }
        if let Some((order, _)) = &self.background {
            used.extend(store.args(*order).textures().map(str::to_owned));
        }
        for (order, texture) in &self.textures {
            let args = store.args(*order);
            if !used.contains(&args.name) {
                continue;
            }
            texture.decode_by(self.setting.camera.display());
            let read = texture.load_within(self.texture_memory);
            self.texture_memory -= texture.bytes().min(self.texture_memory);
            for remark in texture.remarks() {
                let place = self.places.get(*order);
                let parsed = source.entity(self.registry, *order, &place);
                let place = parsed.and_then(|parsed| place_of(args.entity, &parsed, None));
                self.report
                    .add(Fault::warning(place, format!("the file of texture `{}` {remark}", args.name)));
            }
            if let Err(reason) = read {
                let place = self.places.get(*order);
                let is_told = self.report.would_list(Severity::Error, &place);
                let mut files = args.values().filter(|(_, datum)| matches!(datum, Datum::Word(_)));
                let file = files.next();
                let near = match file.as_ref().map(|(_, datum)| datum) {
                    Some(Datum::Word(written)) if is_told && texture.is_missing() => {
                        misplaced::image(&self.setting.folder, written)
                    }
                    _ => None,
                };
                let reason =
                    near.map_or(reason.to_owned(), |near| format!("it does not exist, but `{near}` does"));
                let message = format!("the file of texture `{}` cannot be read: {reason}", args.name);
                let file = file.map(|(file, _)| file.name());
                let parsed = source.entity(self.registry, *order, &place);
                let place = parsed.and_then(|parsed| place_of(args.entity, &parsed, file));
                self.report.add(
                    Fault::error(place, message).help(
                        "a texture is an image, such as a PNG or JPEG, and its name is relative to the scene's folder",
                    ),
                );
            }
        }
    }
}
