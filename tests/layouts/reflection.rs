//! The SPIR-V side: structs, constants, bindings and push constants of the embedded shaders.

use spirq::prelude::*;
use spirq::ty::{ScalarType, SpirvType, StructType, Type};
use worsted::shaders;

/// One member of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    pub name: String,
    pub offset: usize,
    /// As GLSL writes it: `uint`, `vec3`, `vec4[5]`.
    pub kind: String,
}

/// A struct as it lies in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub name: String,
    /// Bytes from one to the next in an array, or of the whole block.
    pub stride: usize,
    pub members: Vec<Member>,
}

/// A descriptor that a shader declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Descriptor {
    pub set: u32,
    pub binding: u32,
    pub kind: DescriptorType,
}

/// What a shader shows of itself.
#[derive(Debug)]
pub struct Reflected {
    pub path: &'static str,
    pub structs: Vec<Layout>,
    pub descriptors: Vec<Descriptor>,
    /// Identifier, name and GLSL type.
    pub constants: Vec<(u32, String, String)>,
    pub push_constants: Option<Layout>,
}

/// Every embedded shader.
pub fn all() -> Vec<Reflected> {
    let all: Vec<_> = shaders::all().map(|(path, words)| reflect(path, words)).collect();
    assert!(all.len() > 8, "found only {} shaders", all.len());
    all
}

/// The module with plain constants in place of what is computed from specialization constants: spirq
/// 1.3 cannot evaluate all of that, and no layout depends on it.
fn without_computed_constants(words: &[u32]) -> Vec<u32> {
    const SPEC_CONSTANT_OP: u32 = 52;
    const CONSTANT_NULL: u32 = 46;
    let (mut kept, mut rest) = (words[..5].to_vec(), &words[5..]);
    while let Some(&head) = rest.first() {
        let (instruction, after) = rest.split_at((head >> 16).max(1) as usize);
        match instruction {
            [_, ty, result, ..] if head & 0xffff == SPEC_CONSTANT_OP => {
                kept.extend([3 << 16 | CONSTANT_NULL, *ty, *result]);
            }
            _ => kept.extend(instruction),
        }
        rest = after;
    }
    kept
}

fn reflect(path: &'static str, words: &[u32]) -> Reflected {
    let entries = ReflectConfig::new().spv(without_computed_constants(words)).ref_all_rscs(true).reflect();
    let entries = entries.unwrap_or_else(|error| panic!("{path}: {error}"));
    assert_eq!(entries.len(), 1, "{path}: one entry point");
    let mut found = Reflected {
        path,
        structs: Vec::new(),
        descriptors: Vec::new(),
        constants: Vec::new(),
        push_constants: None,
    };
    for variable in &entries[0].vars {
        match variable {
            Variable::Descriptor { desc_bind, desc_ty, ty, .. } => {
                let (set, binding) = (desc_bind.set(), desc_bind.bind());
                found.descriptors.push(Descriptor { set, binding, kind: desc_ty.clone() });
                collect_structs(ty, None, &mut found.structs);
            }
            Variable::PushConstant { ty: Type::Struct(block), .. } => {
                let size = block.nbyte().expect("push constants have a size");
                found.push_constants = Some(layout(block, size));
            }
            Variable::SpecConstant { name, spec_id, ty, .. } => {
                let name = name.clone().unwrap_or_default();
                found.constants.push((*spec_id, name, kind(ty)));
            }
            _ => {}
        }
    }
    found
}

/// The structs inside a block. A struct's stride is its array's, or its own size where it is alone.
fn collect_structs(ty: &Type, stride: Option<usize>, into: &mut Vec<Layout>) {
    match ty {
        Type::Struct(block) => {
            let size = stride.or(block.nbyte()).unwrap_or_default();
            into.push(layout(block, size));
            block.members.iter().for_each(|member| collect_structs(&member.ty, None, into));
        }
        Type::Array(array) => collect_structs(&array.element_ty, array.stride, into),
        _ => {}
    }
}

fn layout(block: &StructType, stride: usize) -> Layout {
    let member = |member: &spirq::ty::StructMember| Member {
        name: member.name.clone().unwrap_or_default(),
        offset: member.offset.expect("a member of a block has an offset"),
        kind: kind(&member.ty),
    };
    Layout {
        name: block.name.clone().unwrap_or_default(),
        stride,
        members: block.members.iter().map(member).collect(),
    }
}

/// A type as GLSL writes it.
fn kind(ty: &Type) -> String {
    match ty {
        Type::Scalar(scalar) => scalar_kind(scalar).to_owned(),
        Type::Vector(vector) => {
            let prefix = match scalar_kind(&vector.scalar_ty) {
                "float" => "",
                "uint" => "u",
                "int" => "i",
                _ => "?",
            };
            format!("{prefix}vec{}", vector.nscalar)
        }
        Type::Matrix(matrix) if matrix.nvector == matrix.vector_ty.nscalar && matrix.stride == Some(16) => {
            format!("mat{}", matrix.nvector)
        }
        Type::Array(array) => match array.nelement {
            Some(count) => format!("{}[{count}]", kind(&array.element_ty)),
            None => format!("{}[]", kind(&array.element_ty)),
        },
        Type::Struct(block) => block.name.clone().unwrap_or_default(),
        other => format!("{other:?}"),
    }
}

fn scalar_kind(scalar: &ScalarType) -> &'static str {
    match scalar {
        ScalarType::Boolean => "bool",
        ScalarType::Integer { bits: 32, is_signed: true } => "int",
        ScalarType::Integer { bits: 32, is_signed: false } => "uint",
        ScalarType::Float { bits: 32, .. } => "float",
        _ => "?",
    }
}
