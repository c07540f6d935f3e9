//! What people ask of keys: a whole path, the end of one, or a path that goes on in an asset.

use super::keys::{Key, keys};
use super::{FILES, FileKind};
use crate::scenario::INTO_ASSET;
use crate::suggest::nearest;

/// A kind of file with all its keys.
pub(crate) struct Book {
    /// The kind.
    pub kind: &'static FileKind,
    /// Its keys.
    pub keys: Vec<Key>,
}

/// A key that answers a question, with the book that it stands in.
pub(crate) type Answer<'a> = (&'a Book, &'a Key);

/// All kinds of files with all their keys, scenarios first.
pub(crate) fn books() -> Vec<Book> {
    FILES.iter().map(|kind| Book { kind, keys: keys(&kind.schema()) }).collect()
}

impl Book {
    /// The keys directly in the table of `key`, for the same tasks.
    pub fn inside(&self, key: &Key) -> impl Iterator<Item = &Key> {
        let same_task = |other: &&Key| key.tasks.is_empty() || other.tasks.iter().any(|task| key.tasks.contains(task));
        self.keys.iter().filter(|other| other.is_directly_in(key)).filter(same_task)
    }
}

/// The keys that `question` means: those with this path, else those whose path ends in it.
///
/// # Errors
/// In words, with what was probably meant.
pub(crate) fn answers<'a>(books: &'a [Book], question: &str) -> Result<Vec<Answer<'a>>, String> {
    let (books, path): (Vec<&Book>, &str) = match question.split_once(INTO_ASSET) {
        None => (books.iter().collect(), question),
        Some((owner, path)) => (vec![asset_book(books, owner)?], path),
    };
    let steps: Vec<&str> = path.split('.').collect();
    let find = |is_meant: &dyn Fn(&Key) -> bool| -> Vec<Answer<'a>> {
        let all = books.iter().flat_map(|book| book.keys.iter().map(move |key| (*book, key)));
        all.filter(|(_, key)| is_meant(key)).collect()
    };
    let whole = find(&|key| key.is_at(&steps));
    let found = if whole.is_empty() { find(&|key| key.ends_in(&steps)) } else { whole };
    if found.is_empty() { Err(unknown(&books, path)) } else { Ok(found) }
}

/// The book of the assets that `owner` names: by their own name, or by a key of a scenario that names one of them.
fn asset_book<'a>(books: &'a [Book], owner: &str) -> Result<&'a Book, String> {
    let steps: Vec<&str> = owner.split('.').collect();
    let keys = books.iter().flat_map(|book| &book.keys);
    let folder = keys.filter(|key| key.is_at(&steps)).find_map(|key| key.asset.as_deref());
    let is_meant = |book: &&Book| {
        let own = book.kind.folder.rsplit('/').next();
        book.kind.name == owner || (folder.is_some() && own == folder)
    };
    books.iter().find(is_meant).ok_or_else(|| {
        let kinds: Vec<&str> = books.iter().map(|book| book.kind.name).collect();
        format!(
            "found `{owner}` before the colon; expected a key that names an asset, such as tool.asset, or one of {}",
            kinds.join(", ")
        )
    })
}

fn unknown(books: &[&Book], path: &str) -> String {
    let keys = || books.iter().flat_map(|book| &book.keys);
    let dotted: Vec<String> = keys().map(Key::dotted).collect();
    let mut last: Vec<&str> = keys().filter_map(|key| key.path.last().map(String::as_str)).collect();
    last.sort_unstable();
    last.dedup();
    let end = path.rsplit('.').next().unwrap_or(path);
    let whole = if path.contains('.') { nearest(path, &dotted) } else { None };
    let meant = whole.or_else(|| nearest(end, &last)).map_or_else(
        || "; `wield explain` without a key lists what a file holds".to_owned(),
        |meant| format!("; did you mean `{meant}`?"),
    );
    let kinds: Vec<&str> = books.iter().map(|book| book.kind.name).collect();
    format!("found no key `{}` in any {}{meant}", path.escape_debug(), kinds.join(", "))
}
