//! Checks the normal form that the crate's documentation promises.

use arsc_ir::{Environment, Ir, Leaf, MaterialId, NodeId, NodeKind};

/// What a node is allowed to be a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Solid,
    Surface,
    Light,
    Environment,
    Instance,
    /// A placed light or environment.
    Placed,
    Root,
}

/// Whether an IR that verifies is in the normal form.
///
/// # Errors
/// The first node that is not as it should be, and why.
pub fn check_normal_form(ir: &Ir) -> Result<(), String> {
    let reachable = ir.reachable();
    let mut roles: Vec<Role> = Vec::with_capacity(ir.nodes.len());
    for (id, is_reachable) in reachable.iter().enumerate() {
        if !is_reachable {
            return Err(format!("%{id} is not used"));
        }
        let role = role(ir, NodeId(id as u32), &roles).map_err(|message| format!("%{id} {message}"))?;
        roles.push(role);
    }
    let mut seen: Vec<_> = ir.materials.iter().map(|m| (m.bsdf, m.emitter, m.medium, m.inside, &m.faces)).collect();
    seen.sort_unstable();
    if seen.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err("a material is there twice".to_owned());
    }
    if roles[ir.root.index()] == Role::Root { Ok(()) } else { Err("the root is no group".to_owned()) }
}

fn role(ir: &Ir, id: NodeId, roles: &[Role]) -> Result<Role, &'static str> {
    let kind = ir.kind(id);
    let all_solid = || kind.children().iter().all(|child| roles[child.index()] == Role::Solid);
    match kind {
        NodeKind::Leaf(leaf) => match **leaf {
            Leaf::Solid { material: Some(MaterialId(_)), .. } => Ok(Role::Solid),
            Leaf::Surface { material: Some(MaterialId(_)), .. } => Ok(Role::Surface),
            _ => Err("has no material"),
        },
        NodeKind::Union(_) | NodeKind::Intersection(_) | NodeKind::Difference(_) => match kind.children() {
            [] if !matches!(kind, NodeKind::Union(_)) => Err("is a Boolean node without operands"),
            _ if all_solid() => Ok(Role::Solid),
            _ => Err("has an operand that is no solid"),
        },
        NodeKind::Group(members) if id == ir.root => {
            let rank = |member: &NodeId| match roles[member.index()] {
                Role::Solid | Role::Instance => Ok(0),
                Role::Surface => Ok(1),
                Role::Light | Role::Environment | Role::Placed => Ok(2),
                Role::Root => Err("holds a group"),
            };
            let ranks: Vec<u8> = members.iter().map(rank).collect::<Result<_, _>>()?;
            if ranks.is_sorted() { Ok(Role::Root) } else { Err("does not list solids first") }
        }
        NodeKind::Transform { child, .. } => match (roles[child.index()], ir.kind(*child)) {
            (Role::Solid, _) => Ok(Role::Instance),
            (Role::Light, NodeKind::Light(light)) if light.is_point() => Ok(Role::Placed),
            (Role::Environment, NodeKind::Environment(environment))
                if !matches!(**environment, Environment::Constant { .. } | Environment::Medium { .. }) =>
            {
                Ok(Role::Placed)
            }
            _ => Err("places what takes no map"),
        },
        NodeKind::Light(_) => Ok(Role::Light),
        NodeKind::Environment(_) => Ok(Role::Environment),
        NodeKind::Group(_) => Err("is a group below the root"),
        NodeKind::Attributes { .. } => Err("is a node of attributes"),
    }
}
