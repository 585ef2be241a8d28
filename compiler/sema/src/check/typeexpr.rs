//! Types as they are written.

use arsc_diagnostics::codes::sema as codes;
use arsc_diagnostics::{Diagnostic, Span, closest};
use arsc_syntax::ast::{self, TypeKind};

use super::convert::record;
use super::names::{DefKind, Meaning, with_suggestion};
use super::scope::Context;
use super::{Checker, Progress};
use crate::types::{NAMED, Type};

/// A `type` item.
pub(super) struct TypeState<'a> {
    name: &'a ast::Ident,
    written: &'a ast::TypeExpr,
    module: usize,
    progress: Progress,
    ty: Type,
}

impl<'a> Checker<'a> {
    pub(super) fn new_alias(&mut self, module: usize, name: &'a ast::Ident, written: &'a ast::TypeExpr) -> usize {
        self.types.push(TypeState { name, written, module, progress: Progress::Unchecked, ty: Type::Error });
        self.types.len() - 1
    }

    pub(super) fn resolve_alias(&mut self, i: usize) -> Type {
        let state = &mut self.types[i];
        match state.progress {
            Progress::Done => return state.ty.clone(),
            Progress::Running => {
                let name = state.name;
                let message = format!("the type `{}` contains itself", name.name);
                self.error(codes::CYCLIC_DEFINITION, message, name.span, "contains itself");
                return Type::Error;
            }
            Progress::Unchecked => {}
        }
        state.progress = Progress::Running;
        let (written, module) = (state.written, state.module);
        let outer = std::mem::replace(&mut self.cx, Context::new(module));
        let ty = self.type_expr(written);
        self.cx = outer;
        self.types[i].ty = ty.clone();
        self.types[i].progress = Progress::Done;
        ty
    }

    pub(super) fn type_expr(&mut self, written: &ast::TypeExpr) -> Type {
        let ty = self.written_type(written);
        self.bounded(ty, written.span)
    }

    fn written_type(&mut self, written: &ast::TypeExpr) -> Type {
        match &written.kind {
            TypeKind::Name { name, args } => self.named_type(name, args, written.span),
            TypeKind::Tuple(parts) => Type::tuple(parts.iter().map(|part| self.type_expr(part)).collect::<Vec<_>>()),
            TypeKind::Record(fields) => {
                for (i, (name, _)) in fields.iter().enumerate() {
                    if fields[..i].iter().any(|(known, _)| known.name == name.name) {
                        let message = format!("the field `{}` is given twice", name.name);
                        self.error(codes::DUPLICATE_NAME, message, name.span, "the second");
                        return Type::Error;
                    }
                }
                record(fields.iter().map(|(name, ty)| (name.name.clone(), self.type_expr(ty))).collect())
            }
            TypeKind::Fn { params, result } => {
                let params = params.iter().map(|param| self.type_expr(param)).collect();
                Type::function(params, self.type_expr(result))
            }
            TypeKind::Error => Type::Error,
        }
    }

    fn named_type(&mut self, name: &ast::Ident, args: &[ast::TypeExpr], span: Span) -> Type {
        if name.name == "list" {
            let [element] = args else {
                let message = "`list` needs the type of its elements: `list<solid>`";
                self.error(codes::UNKNOWN_TYPE, message, span, "no element type");
                return Type::Error;
            };
            return Type::list(self.type_expr(element));
        }
        if let ("texture", [of]) = (name.name.as_str(), args) {
            let of_span = of.span;
            let of = self.type_expr(of);
            return match of.texture_kind() {
                Some(kind) if !matches!(of, Type::Texture(_) | Type::Int | Type::Tuple(_)) => Type::Texture(kind),
                _ if of.is_error() => of,
                _ => {
                    let message = format!("there are no textures of `{of}`");
                    let diagnostic = Diagnostic::new(codes::UNKNOWN_TYPE, message).label(of_span, "does not vary");
                    self.report(
                        diagnostic.help("textures are of `bool`, `float`, `angle`, vectors or a kind of spectrum"),
                    );
                    Type::Error
                }
            };
        }
        if !args.is_empty() {
            let message = format!("`{}` takes no type arguments", name.name);
            self.error(codes::UNKNOWN_TYPE, message, span, "only `list` and `texture` do");
            return Type::Error;
        }
        let alias = self.scopes[self.cx.module].defs.contains_key(&name.name);
        match alias.then(|| self.global_meaning(&name.name)).flatten() {
            Some(Meaning::Type(i)) => return self.resolve_alias(i),
            Some(Meaning::Missing) => return Type::Error,
            _ => {}
        }
        match NAMED.iter().find(|(known, _)| *known == name.name) {
            Some((_, ty)) => ty.clone(),
            None => self.unknown_type(name),
        }
    }

    fn unknown_type(&mut self, name: &ast::Ident) -> Type {
        let diagnostic = Diagnostic::new(codes::UNKNOWN_TYPE, format!("there is no type `{}`", name.name));
        let diagnostic = diagnostic.label(name.span, "unknown type");
        let help = match name.name.as_str() {
            "spectrum" => Some(
                "say which kind: `reflectance`, `transmission`, `emission`, `refractive_index`, `extinction` or \
                 `coefficient`",
            ),
            "number" | "double" | "real" | "length" => Some("numbers are `int` or `float`; lengths are `float`"),
            "image" | "film" => Some("images live on the stack of an action sequence, not in values"),
            "instance" => Some("a shape used twice is an instance: no type of its own is needed"),
            _ => None,
        };
        let diagnostic = match help {
            Some(help) => diagnostic.help(help),
            None => {
                let own = self.scopes[self.cx.module].defs.iter();
                let own = own.filter(|(_, def)| matches!(def.kind, DefKind::Type(_))).map(|(name, _)| name.as_str());
                let known = NAMED.iter().map(|(name, _)| *name).chain(["list"]).chain(own);
                let near = closest(&name.name, known).map(str::to_owned);
                with_suggestion(diagnostic, name.span, near.as_deref())
            }
        };
        self.report(diagnostic);
        Type::Error
    }
}
