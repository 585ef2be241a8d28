//! Items of a file, their doc comments and `@allow` attributes.

use arsc_diagnostics::Span;
use pest::Parser;

use super::Builder;
use crate::ast::{Import, ImportName, ImportNames, ImportPath, Item, ItemKind, Param};
use crate::grammar::{Grammar, Pair, Rule};

impl<'t> Builder<'t> {
    /// Reads what stands next in `start..stop` into `items`; gives where it ends, or `None` at the end of the text.
    pub(super) fn top(&mut self, start: usize, stop: usize, comments: &[Span], items: &mut Vec<Item>) -> Option<usize> {
        self.base = start;
        self.too_deep = false;
        let Ok(mut pairs) = Grammar::parse(Rule::top, &self.text[start..stop]) else {
            // Only pest's own guard of the stack can refuse: the rule matches every text.
            self.unreadable(Rule::strict_item, start, stop);
            return None;
        };
        let top = pairs.next()?;
        let end = start + top.as_span().end();
        let mut inner = top.into_inner();
        let pair = inner.next()?;
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::item => {
                let (allow, kind) = self.item(pair);
                let docs = item_docs(self.text, comments, span.start);
                items.push(Item { docs, allow, kind, span });
                if inner.next().is_some_and(|pair| pair.as_rule() == Rule::missing_end) {
                    self.missing_end(span);
                }
            }
            Rule::top_error => {
                self.unreadable(Rule::strict_item, span.start as usize, span.end as usize);
                let kind = self.declared_by_error(span).map_or(ItemKind::Error, ItemKind::Let);
                items.push(Item { docs: None, allow: Vec::new(), kind, span });
            }
            // `;`, and a `}` that the scan has reported.
            _ => {}
        }
        (end > start).then_some(end)
    }

    fn item(&mut self, pair: Pair<'t>) -> (Vec<crate::ast::Ident>, ItemKind) {
        let mut allow = Vec::new();
        for part in pair.into_inner() {
            let kind = match part.as_rule() {
                Rule::attribute => {
                    allow.extend(part.into_inner().map(|name| self.ident(name)));
                    continue;
                }
                Rule::allow => ItemKind::Allow(part.into_inner().map(|name| self.ident(name)).collect()),
                Rule::import => self.import(part),
                Rule::param => self.param(part),
                Rule::let_stmt => ItemKind::Let(self.let_stmt(part).0),
                Rule::fn_decl => ItemKind::Fn(self.fn_decl(part).0),
                Rule::type_decl => self.type_decl(part),
                Rule::scene => part.into_inner().last().map_or(ItemKind::Error, |b| ItemKind::Scene(self.block(b).0)),
                Rule::actions => {
                    part.into_inner().last().map_or(ItemKind::Error, |b| ItemKind::Actions(self.block(b).0))
                }
                Rule::camera => part.into_inner().last().map_or(ItemKind::Error, |e| ItemKind::Camera(self.expr(e).0)),
                _ => ItemKind::Error,
            };
            return (allow, kind);
        }
        (allow, ItemKind::Error)
    }

    fn import(&mut self, pair: Pair<'t>) -> ItemKind {
        let mut path = None;
        let mut names = ImportNames::Module(None);
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::string => path = Some(ImportPath::File { path: self.string(&part), span }),
                Rule::std_path => {
                    path = Some(ImportPath::Std { segments: part.into_inner().map(|s| self.ident(s)).collect(), span });
                }
                Rule::import_names => {
                    names = ImportNames::Names(part.into_inner().filter_map(|name| self.import_name(name)).collect());
                }
                Rule::import_as => names = ImportNames::Module(part.into_inner().last().map(|name| self.ident(name))),
                _ => {}
            }
        }
        path.map_or(ItemKind::Error, |path| ItemKind::Import(Import { path, names }))
    }

    fn import_name(&mut self, pair: Pair<'t>) -> Option<ImportName> {
        let mut names = pair.into_inner().filter(|part| part.as_rule() == Rule::ident);
        let name = self.ident(names.next()?);
        Some(ImportName { name, alias: names.next().map(|alias| self.ident(alias)) })
    }

    fn param(&mut self, pair: Pair<'t>) -> ItemKind {
        let mut inner = pair.into_inner();
        let (mut name, mut ty) = (None, None);
        for part in inner.next().map(Pair::into_inner).into_iter().flatten() {
            match part.as_rule() {
                Rule::ident => name = Some(self.ident(part)),
                Rule::type_expr => ty = Some(self.type_expr(part)),
                _ => {}
            }
        }
        let mut exprs = inner.filter(|part| part.as_rule() == Rule::expr);
        let (Some(name), Some(default)) = (name, exprs.next()) else { return ItemKind::Error };
        let default = self.expr(default).0;
        let range = exprs.next().map(|range| self.expr(range).0);
        ItemKind::Param(Param { name, ty, default, range })
    }

    fn type_decl(&mut self, pair: Pair<'t>) -> ItemKind {
        let mut inner = pair.into_inner().filter(|part| matches!(part.as_rule(), Rule::ident | Rule::type_expr));
        let (Some(name), Some(ty)) = (inner.next(), inner.next()) else { return ItemKind::Error };
        ItemKind::Type { name: self.ident(name), ty: self.type_expr(ty) }
    }
}

/// The `///` lines that stand directly before an item.
fn item_docs(text: &str, comments: &[Span], item_start: u32) -> Option<String> {
    let mut next = item_start as usize;
    let before = comments.partition_point(|comment| comment.end <= item_start);
    let mut lines = Vec::new();
    for comment in comments[..before].iter().rev() {
        let (start, end) = (comment.start as usize, comment.end as usize);
        let body = doc_body(&text[start..end], "///").filter(|body| !body.starts_with('/'));
        let (Some(body), true) = (body, text[end..next].trim().is_empty()) else { break };
        lines.push(body);
        next = start;
    }
    lines.reverse();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

/// The `//!` lines that stand before everything else.
pub(super) fn module_docs(text: &str, comments: &[Span]) -> Option<String> {
    let mut last = 0;
    let mut lines = Vec::new();
    for comment in comments {
        let (start, end) = (comment.start as usize, comment.end as usize);
        let body = doc_body(&text[start..end], "//!");
        let (Some(body), true) = (body, text[last..start].trim_matches([' ', '\t', '\r', '\n', '\u{FEFF}']).is_empty())
        else {
            break;
        };
        lines.push(body);
        last = end;
    }
    (!lines.is_empty()).then(|| lines.join("\n"))
}

fn doc_body<'t>(comment: &'t str, mark: &str) -> Option<&'t str> {
    let body = comment.strip_prefix(mark)?;
    Some(body.strip_prefix(' ').unwrap_or(body).trim_end())
}
