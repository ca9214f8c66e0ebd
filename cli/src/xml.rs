//! What XML files may ask of their parsers, which follow nesting on the stack and reserve what counts announce.

use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

/// The deepest nesting of elements: exporters stay below twenty.
const DEEPEST: usize = 256;

/// Attributes that announce how much follows.
const COUNTS: [&str; 3] = ["count", "offset", "stride"];

/// Lists of names, at which the parser of meshes never ends.
const NAMES: [&[u8]; 2] = [b"Name_array", b"IDREF_array"];

/// Looks through a file without any of that. Of what is no XML its parser tells more.
pub(crate) fn check(bytes: &[u8]) -> Result<(), String> {
    let mut reader = Reader::from_reader(bytes);
    reader.config_mut().check_end_names = false;
    reader.config_mut().allow_unmatched_ends = true;
    let mut depth = 0_usize;
    loop {
        match reader.read_event() {
            Ok(Event::Start(element)) => {
                depth += 1;
                element_of(&element, bytes.len())?;
            }
            Ok(Event::Empty(element)) => element_of(&element, bytes.len())?,
            Ok(Event::End(_)) => depth = depth.saturating_sub(1),
            Ok(Event::Eof) | Err(_) => return Ok(()),
            Ok(_) => {}
        }
        if depth > DEEPEST {
            let at = reader.buffer_position();
            return Err(format!("its elements are nested deeper than {DEEPEST} at byte {at}"));
        }
    }
}

fn element_of(element: &BytesStart<'_>, length: usize) -> Result<(), String> {
    let name = element.local_name();
    if NAMES.contains(&name.as_ref()) {
        let name = String::from_utf8_lossy(name.as_ref());
        return Err(format!("it has names, in a <{name}>, which is not read: export its geometry alone"));
    }
    for attribute in element.attributes().flatten() {
        let number = std::str::from_utf8(&attribute.value).ok().and_then(|text| text.trim().parse::<usize>().ok());
        let is_count = COUNTS.iter().any(|count| count.as_bytes() == attribute.key.as_ref());
        if let Some(number) = number.filter(|number| is_count && *number > length) {
            let key = String::from_utf8_lossy(attribute.key.as_ref());
            return Err(format!("a `{key}` of {number} is more than the file holds"));
        }
    }
    Ok(())
}
