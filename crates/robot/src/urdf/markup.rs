//! The elements of an XML text with their lines; what they mean is not looked at.
//!
//! The parser behind this crate stops at flaws that other URDF readers pass over (`--` in comments, prefixes that are not
//! declared), names no line of the user's file for most others, and recurses as deep as the text nests. This scan has
//! none of these bounds: it keeps elements in one list, so the text may nest as deep as it likes.

use std::ops::Range;

/// A flaw of the markup itself.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Flaw {
    pub line: usize,
    pub found: String,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Attribute<'a> {
    pub name: &'a str,
    /// As written, with its entities.
    pub value: &'a str,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Element<'a> {
    pub name: &'a str,
    /// Line of its start tag, from 1.
    pub line: usize,
    pub attributes: Vec<Attribute<'a>>,
    /// Places in the document's list.
    pub children: Vec<usize>,
}

impl<'a> Element<'a> {
    /// The value of the first attribute of that name.
    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.attributes.iter().find(|attribute| attribute.name == name).map(|attribute| attribute.value)
    }
}

/// All elements in the order of their start tags; the root is the first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Document<'a> {
    pub elements: Vec<Element<'a>>,
}

impl<'a> Document<'a> {
    pub fn scan(text: &'a str) -> Result<Self, Flaw> {
        let mut scanner = Scanner { text, at: 0, line: 1, elements: Vec::new(), open: Vec::new() };
        while scanner.step()? {}
        scanner.finish()
    }

    pub fn root(&self) -> &Element<'a> {
        &self.elements[0]
    }

    pub fn children<'d>(&'d self, element: &'d Element<'a>) -> impl Iterator<Item = &'d Element<'a>> {
        element.children.iter().map(|&child| &self.elements[child])
    }
}

struct Scanner<'a> {
    text: &'a str,
    /// Place of the next byte; always at the start of a character.
    at: usize,
    line: usize,
    elements: Vec<Element<'a>>,
    /// The elements that are not closed yet, outermost first.
    open: Vec<usize>,
}

impl<'a> Scanner<'a> {
    /// Goes past the next piece of markup; false at the end of the text.
    fn step(&mut self) -> Result<bool, Flaw> {
        let Some(start) = self.rest().find('<') else {
            self.pass_text(self.text.len() - self.at)?;
            return Ok(false);
        };
        self.pass_text(start)?;
        let rest = self.rest();
        if rest.starts_with("<!--") {
            self.pass_to("<!--", "-->", "the comment")?;
        } else if rest.starts_with("<![CDATA[") {
            self.pass_to("<![CDATA[", "]]>", "the CDATA section")?;
        } else if rest.starts_with("<?") {
            self.pass_to("<?", "?>", "the processing instruction")?;
        } else if rest.starts_with("<!") {
            self.pass_declaration()?;
        } else if rest.starts_with("</") {
            self.close()?;
        } else {
            self.open()?;
        }
        Ok(true)
    }

    fn finish(self) -> Result<Document<'a>, Flaw> {
        if let Some(&last) = self.open.last() {
            let Element { name, line, .. } = &self.elements[last];
            return Err(Flaw { line: *line, found: format!("<{name}> is not closed") });
        }
        if self.elements.is_empty() {
            return Err(Flaw { line: 1, found: "no element at all".to_owned() });
        }
        Ok(Document { elements: self.elements })
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn flaw(&self, found: impl Into<String>) -> Flaw {
        Flaw { line: self.line, found: found.into() }
    }

    /// Moves on and counts lines; returns what was passed.
    fn advance(&mut self, bytes: usize) -> &'a str {
        let passed = &self.text[self.at..self.at + bytes];
        self.line += passed.bytes().filter(|byte| *byte == b'\n').count();
        self.at += bytes;
        passed
    }

    fn pass_text(&mut self, bytes: usize) -> Result<(), Flaw> {
        let text = &self.rest()[..bytes];
        let outside = self.open.is_empty();
        let blank = text.len() - text.trim_start().len();
        if outside && blank < text.len() {
            self.advance(blank);
            return Err(self.flaw("text outside of the root element"));
        }
        self.advance(bytes);
        Ok(())
    }

    fn pass_to(&mut self, begin: &str, end: &str, what: &str) -> Result<(), Flaw> {
        let Some(length) = self.rest()[begin.len()..].find(end) else {
            return Err(self.flaw(format!("{what} is not closed by `{end}`")));
        };
        self.advance(begin.len() + length + end.len());
        Ok(())
    }

    /// Goes past `<!DOCTYPE …>`, whose internal subset stands in brackets.
    fn pass_declaration(&mut self) -> Result<(), Flaw> {
        let mut brackets = 0_usize;
        for (place, byte) in self.rest().bytes().enumerate() {
            match byte {
                b'[' => brackets += 1,
                b']' => brackets = brackets.saturating_sub(1),
                b'>' if brackets == 0 => {
                    self.advance(place + 1);
                    return Ok(());
                }
                _ => {}
            }
        }
        Err(self.flaw("the declaration is not closed by `>`"))
    }

    fn close(&mut self) -> Result<(), Flaw> {
        let Some(length) = self.rest().find('>') else {
            return Err(self.flaw("the end tag is not closed by `>`"));
        };
        let name = self.rest()[2..length].trim();
        let Some(element) = self.open.pop() else {
            return Err(self.flaw(format!("</{name}> closes nothing")));
        };
        let opened = &self.elements[element];
        if opened.name != name {
            return Err(self.flaw(format!("</{name}> stands where <{}> of line {} ends", opened.name, opened.line)));
        }
        self.advance(length + 1);
        Ok(())
    }

    fn open(&mut self) -> Result<(), Flaw> {
        if self.open.is_empty() && !self.elements.is_empty() {
            return Err(self.flaw("a second root element"));
        }
        let line = self.line;
        self.advance(1);
        let name = self.name().ok_or_else(|| self.flaw("`<` without the name of an element"))?;
        let mut attributes = Vec::new();
        let empty = loop {
            self.pass_blanks();
            if self.rest().starts_with("/>") {
                self.advance(2);
                break true;
            }
            if self.rest().starts_with('>') {
                self.advance(1);
                break false;
            }
            attributes.push(self.attribute(name)?);
        };
        let index = self.elements.len();
        if let Some(&parent) = self.open.last() {
            self.elements[parent].children.push(index);
        }
        self.elements.push(Element { name, line, attributes, children: Vec::new() });
        if !empty {
            self.open.push(index);
        }
        Ok(())
    }

    fn attribute(&mut self, element: &str) -> Result<Attribute<'a>, Flaw> {
        let Some(name) = self.name() else {
            return Err(self.flaw(format!("<{element}> is not closed by `>`")));
        };
        self.pass_blanks();
        let quote = self.rest().strip_prefix('=').map(str::trim_start).and_then(|rest| rest.chars().next());
        let Some(quote @ ('"' | '\'')) = quote else {
            return Err(self.flaw(format!("attribute `{name}` of <{element}> has no quoted value")));
        };
        let begin = self.rest().find(quote).map_or(0, |place| place + 1);
        let Some(length) = self.rest()[begin..].find(quote) else {
            return Err(self.flaw(format!("the value of `{name}` of <{element}> lacks its closing quote")));
        };
        let value: Range<usize> = self.at + begin..self.at + begin + length;
        let value = &self.text[value];
        if value.contains('<') {
            return Err(self.flaw(format!("the value of `{name}` of <{element}> contains `<`; is a quote missing")));
        }
        self.advance(begin + length + 1);
        Ok(Attribute { name, value })
    }

    fn pass_blanks(&mut self) {
        let rest = self.rest();
        self.advance(rest.len() - rest.trim_start().len());
    }

    /// Goes past a name, if there is one.
    fn name(&mut self) -> Option<&'a str> {
        let ends = |character: char| character.is_whitespace() || "=/><'\"&".contains(character);
        let rest = self.rest();
        let length = rest.find(ends).unwrap_or(rest.len());
        let starts = rest.starts_with(|first: char| first.is_alphabetic() || first == '_' || first == ':');
        (length > 0 && starts).then(|| self.advance(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flaw(text: &str) -> (usize, String) {
        let flaw = Document::scan(text).expect_err("the text is flawed");
        (flaw.line, flaw.found)
    }

    #[test]
    fn elements_keep_their_lines_across_comments_and_declarations() {
        let text = "<?xml version='1.0'?>\n<!DOCTYPE r [\n<!ENTITY x '>'>\n]>\r\n<!-- a -- b\n-->\n<r a='1'\n b = \"x>y\"><c/>\n<c/></r>\n";
        let document = Document::scan(text).expect("well formed");
        let lines: Vec<usize> = document.elements.iter().map(|element| element.line).collect();
        assert_eq!(lines, [7, 8, 9]);
        assert_eq!(document.root().attribute("b"), Some("x>y"));
        assert_eq!(document.root().children, [1, 2]);
    }

    #[test]
    fn flaws_are_told_with_their_line() {
        assert_eq!(flaw("<a>\n<b>\n</a>"), (3, "</a> stands where <b> of line 2 ends".to_owned()));
        assert_eq!(flaw("<a>\n<b>\n"), (2, "<b> is not closed".to_owned()));
        assert_eq!(flaw("<a/>\n\nword"), (3, "text outside of the root element".to_owned()));
        assert_eq!(flaw("<a/>\n<b/>"), (2, "a second root element".to_owned()));
        assert_eq!(flaw("</a>"), (1, "</a> closes nothing".to_owned()));
        assert_eq!(flaw("<a>\n<!-- "), (2, "the comment is not closed by `-->`".to_owned()));
        assert_eq!(flaw("<a\n b=1/>"), (2, "attribute `b` of <a> has no quoted value".to_owned()));
        assert!(flaw("<a b=\"1>\n<c d=\"2\"/></a>").1.contains("is a quote missing"));
    }

    #[test]
    fn a_million_levels_do_not_overflow_the_stack() {
        const LEVELS: usize = 1_000_000;
        let text = "<a>".repeat(LEVELS) + &"</a>".repeat(LEVELS);
        assert_eq!(Document::scan(&text).expect("well formed").elements.len(), LEVELS);
    }
}
