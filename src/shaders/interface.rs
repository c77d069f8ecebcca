//! What a shader is to all around it: what it reads and writes, how that lies in memory, and what it asks of the device.
//! Two shaders with the same interface may stand in each other's place.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Capability, Decoration, ExecutionModel, Op, StorageClass, Word};
use std::collections::{BTreeMap, BTreeSet};

/// Every Vulkan device has these.
const FREE_CAPABILITIES: [Capability; 6] = [
    Capability::Matrix,
    Capability::Shader,
    Capability::ImageQuery,
    Capability::DerivativeControl,
    Capability::Sampled1D,
    Capability::SampledBuffer,
];

/// A shader's interface, as texts that are compared and shown.
#[derive(Debug, Default)]
struct Interface {
    /// Each part: its place, and what is there.
    parts: BTreeMap<String, String>,
    /// What it asks of the device, what the device tells it, and what it writes to: another shader may do with less.
    uses: BTreeSet<String>,
}

/// How the interface of `edited` differs from that of `embedded`: a line for each part.
///
/// # Errors
/// Words that are no SPIR-V.
pub fn differences(embedded: &[u32], edited: &[u32]) -> Result<Vec<String>, String> {
    let (ours, theirs) = (Interface::of(embedded)?, Interface::of(edited)?);
    let places: BTreeSet<&String> = ours.parts.keys().chain(theirs.parts.keys()).collect();
    let of = |parts: &BTreeMap<String, String>, place: &String| parts.get(place).cloned();
    let none = || "none".to_owned();
    let parts: Vec<(String, String)> = places
        .into_iter()
        .filter_map(|place| {
            let (expected, found) = (of(&ours.parts, place), of(&theirs.parts, place));
            let differs = expected != found;
            let [expected, found] = [expected, found].map(|part| part.unwrap_or_else(none));
            differs.then(|| (place.clone(), format!("{place}: expected {expected}, found {found}")))
        })
        .collect();
    let is_named = |new: &str| parts.iter().any(|(place, _)| new.starts_with(&format!("{place}, ")));
    let uses = theirs.uses.difference(&ours.uses).filter(|new| !is_named(new));
    let uses: Vec<String> = uses.map(|new| format!("{new}: not in this build's shader")).collect();
    Ok(parts.into_iter().map(|(_, line)| line).chain(uses).collect())
}

impl Interface {
    fn of(words: &[u32]) -> Result<Self, String> {
        let module = rspirv::dr::load_words(words).map_err(|error| format!("not SPIR-V: {error}"))?;
        let reader = Reader::new(&module);
        let mut found = Self::default();
        let model = found.entry(&module)?;
        for global in &module.types_global_values {
            match global.class.opcode {
                Op::Variable => found.variable(&reader, global, model),
                Op::SpecConstant | Op::SpecConstantTrue | Op::SpecConstantFalse => {
                    let id = reader.decoration(global.result_id, Decoration::SpecId);
                    let kind = global.result_type.map(|ty| reader.kind(ty)).unwrap_or_default();
                    found.parts.insert(format!("specialization constant {}", text(id)), kind);
                }
                Op::SpecConstantComposite => {
                    if let Some(built_in) = reader.built_in(global.result_id) {
                        found.parts.insert(format!("{built_in:?}"), "by specialization constants".to_owned());
                    }
                }
                _ => (),
            }
        }
        Ok(found)
    }

    /// The stage, its modes, and what the module asks of the device.
    fn entry(&mut self, module: &Module) -> Result<ExecutionModel, String> {
        let [entry] = &module.entry_points[..] else {
            return Err(format!("expected one entry point, found {}", module.entry_points.len()));
        };
        let Some(Operand::ExecutionModel(model)) = entry.operands.first() else {
            return Err("expected an entry point of a stage".to_owned());
        };
        let name = entry.operands.get(2).map(|name| format!("{name:?}")).unwrap_or_default();
        self.parts.insert("stage".to_owned(), format!("{model:?} {name}"));
        for mode in &module.execution_modes {
            let mut words = mode.operands.iter().skip(1).map(shown);
            let place = format!("mode {}", words.next().unwrap_or_default());
            self.parts.insert(place, format!("({})", words.collect::<Vec<_>>().join(", ")));
        }
        for instruction in &module.capabilities {
            if let Some(Operand::Capability(capability)) = instruction.operands.first()
                && !FREE_CAPABILITIES.contains(capability)
            {
                self.uses.insert(format!("capability {capability:?}"));
            }
        }
        for instruction in module.extensions.iter().chain(&module.ext_inst_imports) {
            self.uses
                .insert(format!("extension {}", instruction.operands.iter().map(shown).collect::<String>()));
        }
        Ok(*model)
    }

    fn variable(&mut self, reader: &Reader<'_>, variable: &Instruction, model: ExecutionModel) {
        let Some((Operand::StorageClass(class), pointer)) =
            variable.operands.first().zip(variable.result_type)
        else {
            return;
        };
        let (id, kind) = (variable.result_id, reader.kind(pointer));
        let number = |decoration| text(reader.decoration(id, decoration));
        match class {
            StorageClass::Input | StorageClass::Output => {
                let way = format!("{class:?}").to_lowercase();
                if let Some(location) = reader.decoration(id, Decoration::Location) {
                    let component = reader.decoration(id, Decoration::Component);
                    let component = component.map_or(String::new(), |at| format!(", component {at}"));
                    let patch = if reader.has(id, Decoration::Patch) { " of a patch" } else { "" };
                    self.parts
                        .insert(format!("{way} at location {location}{component}"), format!("{kind}{patch}"));
                } else {
                    let strange = |built_in: &BuiltIn| !is_free(*built_in, *class, model);
                    let built_ins = reader.built_ins(id, pointer).into_iter().filter(strange);
                    self.uses.extend(built_ins.map(|built_in| format!("built-in {way} {built_in:?}")));
                }
            }
            StorageClass::PushConstant => drop(self.parts.insert("push constants".to_owned(), kind)),
            StorageClass::Workgroup => {
                let shared = self.parts.entry("shared memory".to_owned()).or_default();
                *shared = format!("{shared}{kind}; ");
            }
            StorageClass::Private | StorageClass::Function => (),
            _ => {
                let (set, binding) = (number(Decoration::DescriptorSet), number(Decoration::Binding));
                let access = reader.access(id);
                let place = format!("set {set}, binding {binding}");
                if reader.may_be_written(id, pointer) && *class != StorageClass::Uniform {
                    self.uses.insert(format!("{place}, to be written"));
                }
                self.parts.insert(place, format!("{class:?} {access}{kind}"));
            }
        }
    }
}

/// Whether every shader of this stage may have it, whatever the stages around it do.
fn is_free(built_in: BuiltIn, class: StorageClass, model: ExecutionModel) -> bool {
    use ExecutionModel as Model;
    let free: &[BuiltIn] = match model {
        Model::Vertex => &[BuiltIn::VertexIndex, BuiltIn::InstanceIndex],
        Model::TessellationControl => &[BuiltIn::InvocationId, BuiltIn::PrimitiveId, BuiltIn::PatchVertices],
        Model::TessellationEvaluation => &[BuiltIn::TessCoord, BuiltIn::PrimitiveId, BuiltIn::PatchVertices],
        Model::Geometry => &[BuiltIn::PrimitiveId],
        Model::Fragment => &[BuiltIn::FragCoord, BuiltIn::FrontFacing],
        Model::GLCompute => &[
            BuiltIn::GlobalInvocationId,
            BuiltIn::LocalInvocationId,
            BuiltIn::LocalInvocationIndex,
            BuiltIn::WorkgroupId,
            BuiltIn::NumWorkgroups,
        ],
        _ => &[],
    };
    class == StorageClass::Input && free.contains(&built_in)
}

fn text(number: Option<u32>) -> String {
    number.map_or("none".to_owned(), |number| number.to_string())
}

fn shown(operand: &Operand) -> String {
    match operand {
        Operand::LiteralBit32(word) => word.to_string(),
        Operand::LiteralString(text) => text.clone(),
        Operand::ExecutionMode(mode) => format!("{mode:?}"),
        Operand::Dim(dim) => format!("{dim:?}"),
        Operand::ImageFormat(format) => format!("{format:?}"),
        other => format!("{other:?}"),
    }
}

/// Looks up what a module says of its ids.
struct Reader<'a> {
    globals: BTreeMap<Word, &'a Instruction>,
    names: BTreeMap<(Word, u32), &'a str>,
    /// Of each id what decorates it, and of each member of a struct likewise.
    decorations: BTreeMap<(Word, Option<u32>), Vec<&'a [Operand]>>,
    /// Ids that functions name.
    named: BTreeSet<Word>,
}

impl<'a> Reader<'a> {
    fn new(module: &'a Module) -> Self {
        let globals = module.types_global_values.iter();
        let mut reader = Self {
            globals: globals.filter_map(|global| Some((global.result_id?, global))).collect(),
            names: BTreeMap::new(),
            decorations: BTreeMap::new(),
            named: BTreeSet::new(),
        };
        for name in &module.debug_names {
            if let [Operand::IdRef(id), Operand::LiteralBit32(member), Operand::LiteralString(name)] =
                &name.operands[..]
            {
                reader.names.insert((*id, *member), name);
            }
        }
        for annotation in &module.annotations {
            let (key, rest) = match (annotation.class.opcode, &annotation.operands[..]) {
                (Op::Decorate, [Operand::IdRef(id), rest @ ..]) => ((*id, None), rest),
                (Op::MemberDecorate, [Operand::IdRef(id), Operand::LiteralBit32(member), rest @ ..]) => {
                    ((*id, Some(*member)), rest)
                }
                _ => continue,
            };
            reader.decorations.entry(key).or_default().push(rest);
        }
        for instruction in module.functions.iter().flat_map(|function| function.all_inst_iter()) {
            reader.named.extend(instruction.operands.iter().filter_map(Operand::id_ref_any));
        }
        reader
    }

    fn of(&self, id: Option<Word>, member: Option<u32>) -> impl Iterator<Item = &'a [Operand]> {
        id.and_then(|id| self.decorations.get(&(id, member))).into_iter().flatten().copied()
    }

    fn has(&self, id: Option<Word>, decoration: Decoration) -> bool {
        self.of(id, None).any(|found| found.first() == Some(&Operand::Decoration(decoration)))
    }

    /// The number that decorates an id.
    fn decoration(&self, id: Option<Word>, decoration: Decoration) -> Option<u32> {
        self.of(id, None).find_map(|found| match found {
            [Operand::Decoration(of), Operand::LiteralBit32(number)] if *of == decoration => Some(*number),
            _ => None,
        })
    }

    fn built_in(&self, id: Option<Word>) -> Option<BuiltIn> {
        self.of(id, None).find_map(built_in_of)
    }

    /// The built-in that a variable is, or the members of the block that it is.
    fn built_ins(&self, id: Option<Word>, pointer: Word) -> Vec<BuiltIn> {
        let block = self.behind(pointer);
        let members = self.decorations.iter().filter(|((of, member), _)| *of == block && member.is_some());
        let of_members = members.flat_map(|(_, found)| found.iter().copied().find_map(built_in_of));
        self.built_in(id).into_iter().chain(of_members).collect()
    }

    /// The type that a pointer points to, or that an array is of.
    fn behind(&self, ty: Word) -> Word {
        let next = self.globals.get(&ty).and_then(|found| match (found.class.opcode, &found.operands[..]) {
            (Op::TypePointer, [_, Operand::IdRef(to)]) if !is_address(found) => Some(*to),
            (Op::TypeArray | Op::TypeRuntimeArray, [Operand::IdRef(of), ..]) => Some(*of),
            _ => None,
        });
        next.map_or(ty, |next| self.behind(next))
    }

    /// What may be done with a resource, where the variable itself says it.
    fn access(&self, id: Option<Word>) -> String {
        let access = [(Decoration::NonWritable, "readonly "), (Decoration::NonReadable, "writeonly ")];
        access.into_iter().filter(|(of, _)| self.has(id, *of)).map(|(_, word)| word).collect()
    }

    /// Whether functions name a resource whose memory is not read only.
    fn may_be_written(&self, id: Option<Word>, pointer: Word) -> bool {
        let block = self.behind(pointer);
        let read_only = Operand::Decoration(Decoration::NonWritable);
        let is_block = self.globals.get(&block).is_some_and(|ty| ty.class.opcode == Op::TypeStruct);
        let is_image = self.globals.get(&block).is_some_and(|ty| ty.class.opcode == Op::TypeImage);
        let of_members = || {
            let mut members =
                self.decorations.iter().filter(|((of, member), _)| *of == block && member.is_some());
            members.any(|(_, found)| found.iter().any(|found| found.first() == Some(&read_only)))
        };
        let written = (is_block && !of_members()) || is_image;
        written && !self.has(id, Decoration::NonWritable) && id.is_some_and(|id| self.named.contains(&id))
    }

    /// A type, much as GLSL writes it, with how it lies in memory.
    fn kind(&self, ty: Word) -> String {
        let Some(found) = self.globals.get(&ty) else { return "unknown".to_owned() };
        let inner = |place: usize| match found.operands.get(place) {
            Some(Operand::IdRef(id)) => self.kind(*id),
            _ => String::new(),
        };
        let number = |place: usize| match found.operands.get(place) {
            Some(Operand::LiteralBit32(number)) => *number,
            _ => 0,
        };
        match found.class.opcode {
            Op::TypeBool => "bool".to_owned(),
            Op::TypeInt => format!("{}{}", if number(1) == 1 { "int" } else { "uint" }, width(number(0))),
            Op::TypeFloat => format!("float{}", width(number(0))),
            Op::TypeVector => match inner(0).as_str() {
                "float" => format!("vec{}", number(1)),
                scalar => format!("{}vec{}", scalar.get(..1).unwrap_or("?"), number(1)),
            },
            Op::TypeMatrix => format!("mat{}x{}", number(1), inner(0)),
            Op::TypeArray => format!("{}[{}]{}", inner(0), self.length(found), self.stride(ty)),
            Op::TypeRuntimeArray => format!("{}[]{}", inner(0), self.stride(ty)),
            Op::TypePointer if is_address(found) => "address".to_owned(),
            Op::TypePointer => inner(1),
            Op::TypeSampledImage => format!("sampled {}", inner(0)),
            Op::TypeImage => {
                let rest: Vec<String> = found.operands.iter().skip(1).map(shown).collect();
                format!("image of {} ({})", inner(0), rest.join(" "))
            }
            Op::TypeStruct => {
                let members = (0..).zip(&found.operands).map(|(member, kind)| {
                    let kind = kind.id_ref_any().map(|kind| self.kind(kind)).unwrap_or_default();
                    let name = self.names.get(&(ty, member)).copied().unwrap_or("?");
                    format!("{kind} {name}{};", self.layout(ty, member))
                });
                format!("{{ {} }}", members.collect::<Vec<_>>().join(" "))
            }
            other => format!("{other:?}"),
        }
    }

    fn length(&self, array: &Instruction) -> String {
        let length = array.operands.get(1).and_then(Operand::id_ref_any).and_then(|id| self.globals.get(&id));
        match length.map(|length| (length.class.opcode, length.operands.first())) {
            Some((Op::Constant, Some(Operand::LiteralBit32(length)))) => length.to_string(),
            _ => "by specialization constants".to_owned(),
        }
    }

    fn stride(&self, ty: Word) -> String {
        let stride = self.decoration(Some(ty), Decoration::ArrayStride);
        stride.map_or(String::new(), |bytes| format!(" every {bytes} bytes"))
    }

    /// All that decorates a member.
    fn layout(&self, ty: Word, member: u32) -> String {
        let told = |found: &[Operand]| match found {
            [Operand::Decoration(Decoration::Offset), Operand::LiteralBit32(bytes)] => format!(" at {bytes}"),
            [Operand::Decoration(decoration), rest @ ..] => {
                let rest: String = rest.iter().map(|operand| format!(" {}", shown(operand))).collect();
                format!(" {decoration:?}{rest}")
            }
            _ => String::new(),
        };
        let told: BTreeSet<String> = self.of(Some(ty), Some(member)).map(told).collect();
        told.into_iter().collect()
    }
}

/// Whether it points anywhere in memory: what is there may point back.
fn is_address(pointer: &Instruction) -> bool {
    pointer.operands.first() == Some(&Operand::StorageClass(StorageClass::PhysicalStorageBuffer))
}

/// Of 32 bits nothing is said.
fn width(bits: u32) -> String {
    if bits == 32 { String::new() } else { bits.to_string() }
}

fn built_in_of(found: &[Operand]) -> Option<BuiltIn> {
    match found {
        [Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(built_in)] => Some(*built_in),
        _ => None,
    }
}
