//! Whether a shader works out every value before it uses it.
//!
//! The compiler does not see to that: a `const` made of specialization constants by `&&`, `||` or `?:` it works out where
//! it is used first, and takes it from there wherever else it is used, though another way may lead to that place.

use petgraph::algo::dominators::{Dominators, simple_fast};
use petgraph::graphmap::DiGraphMap;
use rspirv::dr::{Block, Function, Instruction, Module, Operand};
use rspirv::spirv::{Op, Word};
use std::collections::{HashMap, HashSet};

/// What is wrong with a shader that uses a value before it is there, by its name.
///
/// # Errors
/// Words that are no SPIR-V.
pub fn used_too_early(words: &[u32]) -> Result<Option<String>, String> {
    let module = rspirv::dr::load_words(words).map_err(|error| format!("not SPIR-V: {error}"))?;
    let wrong = in_globals(&module).or_else(|| {
        let globals = globals(&module).collect();
        module.functions.iter().find_map(|function| Ways::of(function, &globals)?.wrong(function))
    });
    Ok(wrong.map(|id| {
        let named = module.debug_names.iter().find_map(|name| match &name.operands[..] {
            [Operand::IdRef(of), Operand::LiteralString(name)] if *of == id => Some(format!("`{name}`")),
            _ => None,
        });
        let what = named.unwrap_or_else(|| "a constant expression".to_owned());
        format!(
            "{what} is used where it is not worked out yet, by a fault of the compiler: expected a `const` of \
             specialization constants and `&&`, `||` or `?:` to be used first where all its uses are behind"
        )
    }))
}

/// Ids that functions may use wherever they are.
fn globals(module: &Module) -> impl Iterator<Item = Word> + '_ {
    let values = module.types_global_values.iter().chain(&module.ext_inst_imports);
    let functions = module.functions.iter().filter_map(Function::def_id);
    values.filter_map(|global| global.result_id).chain(functions)
}

fn ids(instruction: &Instruction) -> impl Iterator<Item = Word> + '_ {
    instruction.result_type.into_iter().chain(instruction.operands.iter().filter_map(Operand::id_ref_any))
}

/// A global that one before it is made of.
fn in_globals(module: &Module) -> Option<Word> {
    let mut known = HashSet::new();
    for global in &module.types_global_values {
        if global.class.opcode == Op::TypeForwardPointer {
            known.extend(ids(global));
        }
        let early = ids(global).find(|id| !known.contains(id));
        if early.is_some() {
            return early;
        }
        known.extend(global.result_id);
    }
    None
}

/// The ways through a function.
struct Ways<'a> {
    /// Ids that are there from the start.
    given: HashSet<Word>,
    globals: &'a HashSet<Word>,
    /// Where each id is made: in which block, and as which of its instructions.
    made: HashMap<Word, (Word, usize)>,
    dominators: Dominators<Word>,
}

fn label(block: &Block) -> Option<Word> {
    block.label.as_ref().and_then(|label| label.result_id)
}

impl<'a> Ways<'a> {
    /// None of a function without a body.
    fn of(function: &Function, globals: &'a HashSet<Word>) -> Option<Self> {
        let labels: HashSet<Word> = function.blocks.iter().filter_map(label).collect();
        let (mut graph, mut made) = (DiGraphMap::<Word, ()>::new(), HashMap::new());
        for block in &function.blocks {
            let from = label(block)?;
            graph.add_node(from);
            let last = block.instructions.last().into_iter().flat_map(ids);
            for to in last.filter(|id| labels.contains(id)) {
                graph.add_edge(from, to, ());
            }
            let results = block.instructions.iter().enumerate();
            made.extend(results.filter_map(|(place, made)| Some((made.result_id?, (from, place)))));
        }
        let dominators = simple_fast(&graph, function.blocks.first().and_then(label)?);
        let parameters = function.parameters.iter().filter_map(|parameter| parameter.result_id);
        Some(Self { given: labels.into_iter().chain(parameters).collect(), globals, made, dominators })
    }

    /// Whether an id is there before the `place`-th instruction of a block. In blocks that nothing leads to all are.
    fn is_there(&self, id: Word, block: Word, place: usize) -> bool {
        if self.globals.contains(&id) || self.given.contains(&id) {
            return true;
        }
        let Some(mut before) = self.dominators.dominators(block) else { return true };
        self.made.get(&id).is_some_and(|(maker, made)| match *maker == block {
            true => *made < place,
            false => before.any(|dominator| dominator == *maker),
        })
    }

    /// An id that is used too early.
    fn wrong(&self, function: &Function) -> Option<Word> {
        function.blocks.iter().find_map(|block| {
            let here = label(block)?;
            block.instructions.iter().enumerate().find_map(|(place, instruction)| {
                if instruction.class.opcode == Op::Phi {
                    let values = instruction.operands.chunks_exact(2).filter_map(|pair| {
                        let (value, from) = (pair[0].id_ref_any()?, pair[1].id_ref_any()?);
                        (!self.is_there(value, from, usize::MAX)).then_some(value)
                    });
                    return { values }.next();
                }
                ids(instruction).find(|id| !self.is_there(*id, here, place))
            })
        })
    }
}
