//! Shaders without what their specialization constants leave out.
//!
//! A pipeline's layout must name every descriptor that its SPIR-V declares, used or not: a driver drops dead code, but
//! only after the descriptor had to be there. So what a constant switches off is taken out of the words first:
//! branches, the functions that only they call, and the resources that only those read.

use super::error::VulkanError;
use super::shader::SpecializationConstants;
use rspirv::binary::Assemble;
use rspirv::dr::{Block, Function, Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

/// What is known of an id before the shader runs: a number, or a truth value as 0 or 1.
type Known = HashMap<Word, u32>;

/// The words of a shader without the code and the resources that these constants leave out.
///
/// # Errors
/// [`VulkanError::Misuse`] for words that are no SPIR-V.
pub fn trimmed(spirv: &[u32], constants: &SpecializationConstants) -> Result<Vec<u32>, VulkanError> {
    let mut module = rspirv::dr::load_words(spirv)
        .map_err(|error| VulkanError::misuse(format!("a shader that is no SPIR-V: {error}")))?;
    let known = known_globals(&module, constants);
    for function in &mut module.functions {
        // What one branch decides may decide another.
        while straighten(function, &known) {}
    }
    drop_uncalled(&mut module);
    drop_unread(&mut module);
    Ok(module.assemble())
}

fn known_globals(module: &Module, constants: &SpecializationConstants) -> Known {
    let spec_ids: HashMap<Word, u32> = module.annotations.iter().filter_map(spec_id).collect();
    let mut known = Known::new();
    for global in &module.types_global_values {
        let Some(id) = global.result_id else { continue };
        let default = match (global.class.opcode, global.operands.first()) {
            (Op::ConstantTrue | Op::SpecConstantTrue, _) => Some(1),
            (Op::ConstantFalse | Op::SpecConstantFalse, _) => Some(0),
            (Op::Constant | Op::SpecConstant, Some(Operand::LiteralBit32(word))) => Some(*word),
            (Op::SpecConstantOp, Some(Operand::LiteralSpecConstantOpInteger(op))) => {
                evaluate(*op, &global.operands[1..], &known)
            }
            _ => None,
        };
        let given = spec_ids.get(&id).and_then(|spec_id| constants.word(*spec_id));
        if let Some(value) = given.or(default) {
            known.insert(id, value);
        }
    }
    known
}

/// The id and the `constant_id` of a decoration that gives one.
fn spec_id(annotation: &Instruction) -> Option<(Word, u32)> {
    match annotation.operands[..] {
        [Operand::IdRef(id), Operand::Decoration(Decoration::SpecId), Operand::LiteralBit32(spec_id)] => {
            Some((id, spec_id))
        }
        _ => None,
    }
}

/// The value of an operation, where its operands decide it.
fn evaluate(op: Op, operands: &[Operand], known: &Known) -> Option<u32> {
    let value = |place: usize| operands.get(place)?.id_ref_any().and_then(|id| known.get(&id).copied());
    let (a, b) = (value(0), value(1));
    let both = |holds: fn(u32, u32) -> bool| a.zip(b).map(|(a, b)| u32::from(holds(a, b)));
    match op {
        Op::LogicalNot => a.map(|a| u32::from(a == 0)),
        Op::LogicalAnd if a == Some(0) || b == Some(0) => Some(0),
        Op::LogicalOr if a == Some(1) || b == Some(1) => Some(1),
        Op::LogicalAnd => both(|a, b| a & b != 0),
        Op::LogicalOr => both(|a, b| a | b != 0),
        Op::LogicalEqual | Op::IEqual => both(|a, b| a == b),
        Op::LogicalNotEqual | Op::INotEqual => both(|a, b| a != b),
        Op::UGreaterThan => both(|a, b| a > b),
        Op::UGreaterThanEqual => both(|a, b| a >= b),
        Op::ULessThan => both(|a, b| a < b),
        Op::ULessThanEqual => both(|a, b| a <= b),
        // From one block alone, since the others do not lead here.
        Op::Phi if operands.len() == 2 => a,
        Op::Select => value(if a? == 0 { 2 } else { 1 }),
        _ => None,
    }
}

/// Takes decided branches out of a function, and the blocks that nothing leads to any more; whether there were any.
fn straighten(function: &mut Function, globals: &Known) -> bool {
    let mut known = globals.clone();
    let mut decided = false;
    let headers = loop_headers(&function.blocks);
    for block in &mut function.blocks {
        for instruction in &block.instructions {
            if let Some(id) = instruction.result_id
                && let Some(value) = evaluate(instruction.class.opcode, &instruction.operands, &known)
            {
                known.insert(id, value);
            }
        }
        decided |= decide(block, &known, &headers);
    }
    let reached = reached(&function.blocks);
    let needed = needed_as_targets(&function.blocks, &reached);
    function
        .blocks
        .retain(|block| label(block).is_some_and(|id| reached.contains(&id) || needed.contains_key(&id)));
    for block in &mut function.blocks {
        let Some(id) = label(block).filter(|id| !reached.contains(id)) else { continue };
        // Named by a merge instruction, but never run: a continue block must lead back to its loop.
        block.instructions = vec![match needed.get(&id) {
            Some(Some(header)) => Instruction::new(Op::Branch, None, None, vec![Operand::IdRef(*header)]),
            _ => Instruction::new(Op::Unreachable, None, None, Vec::new()),
        }];
    }
    mend_phis(&mut function.blocks);
    decided
}

/// Labels of the blocks that loops begin with.
fn loop_headers(blocks: &[Block]) -> HashSet<Word> {
    let is_header =
        |block: &&Block| block.instructions.iter().any(|merge| merge.class.opcode == Op::LoopMerge);
    blocks.iter().filter(is_header).filter_map(label).collect()
}

/// Replaces a branch whose condition is known by a jump, if it is. What leads back to a loop's header stays: a loop must have
/// a way back, even one that is never taken.
fn decide(block: &mut Block, known: &Known, headers: &HashSet<Word>) -> bool {
    if successors(block).any(|target| headers.contains(&target)) {
        return false;
    }
    let Some(last) = block.instructions.last() else { return false };
    let selector = || last.operands.first()?.id_ref_any().and_then(|id| known.get(&id).copied());
    let target = match last.class.opcode {
        Op::BranchConditional => {
            selector().and_then(|c| last.operands.get(if c == 0 { 2 } else { 1 }).cloned())
        }
        Op::Switch => selector().and_then(|value| {
            let case = |pair: &[Operand]| (pair[0] == Operand::LiteralBit32(value)).then(|| pair[1].clone());
            last.operands[2..].chunks_exact(2).find_map(case).or_else(|| last.operands.get(1).cloned())
        }),
        _ => None,
    };
    let Some(target) = target else { return false };
    block.instructions.pop();
    if block.instructions.last().is_some_and(|last| last.class.opcode == Op::SelectionMerge) {
        block.instructions.pop();
    }
    block.instructions.push(Instruction::new(Op::Branch, None, None, vec![target]));
    true
}

fn label(block: &Block) -> Option<Word> {
    block.label.as_ref().and_then(|label| label.result_id)
}

/// Where a block may go on.
fn successors(block: &Block) -> impl Iterator<Item = Word> + '_ {
    let last = block.instructions.last();
    let skipped = last.map_or(0, |last| match last.class.opcode {
        Op::Branch => 0,
        Op::BranchConditional | Op::Switch => 1,
        _ => usize::MAX,
    });
    last.into_iter().flat_map(move |last| last.operands.iter().skip(skipped)).filter_map(Operand::id_ref_any)
}

/// Labels of the blocks that the first one leads to.
fn reached(blocks: &[Block]) -> HashSet<Word> {
    let by_label: HashMap<Word, &Block> =
        blocks.iter().filter_map(|block| Some((label(block)?, block))).collect();
    let mut reached = HashSet::new();
    let mut open: Vec<Word> = blocks.first().and_then(label).into_iter().collect();
    while let Some(id) = open.pop() {
        if reached.insert(id)
            && let Some(block) = by_label.get(&id)
        {
            open.extend(successors(block));
        }
    }
    reached
}

/// Blocks that merge instructions of reached ones name: those that continue a loop with its header.
fn needed_as_targets(blocks: &[Block], reached: &HashSet<Word>) -> HashMap<Word, Option<Word>> {
    let mut needed = HashMap::new();
    for block in blocks {
        let Some(header) = label(block).filter(|id| reached.contains(id)) else { continue };
        for merge in &block.instructions {
            let targets = merge.operands.iter().filter_map(Operand::id_ref_any);
            match merge.class.opcode {
                Op::SelectionMerge => needed.extend(targets.take(1).map(|id| (id, None))),
                Op::LoopMerge => {
                    needed.extend(targets.zip([None, Some(header)]));
                }
                _ => {}
            }
        }
    }
    needed
}

/// Takes out of every phi what comes from blocks that do not lead here any more.
fn mend_phis(blocks: &mut [Block]) {
    let mut sources: HashMap<Word, HashSet<Word>> = HashMap::new();
    for block in blocks.iter() {
        for target in successors(block) {
            sources.entry(target).or_default().extend(label(block));
        }
    }
    for block in blocks {
        let from = label(block).and_then(|id| sources.get(&id)).cloned().unwrap_or_default();
        for phi in block.instructions.iter_mut().filter(|i| i.class.opcode == Op::Phi) {
            let comes = |pair: &&[Operand]| pair[1].id_ref_any().is_some_and(|id| from.contains(&id));
            phi.operands = phi.operands.chunks_exact(2).filter(comes).flatten().cloned().collect();
        }
    }
}

/// Takes out functions that no entry point leads to.
fn drop_uncalled(module: &mut Module) {
    let mut open: Vec<Word> =
        module.entry_points.iter().filter_map(|entry| entry.operands.get(1)?.id_ref_any()).collect();
    let mut called = HashSet::new();
    while let Some(id) = open.pop() {
        if !called.insert(id) {
            continue;
        }
        let function = module.functions.iter().find(|f| f.def_id() == Some(id));
        let instructions = function.into_iter().flat_map(Function::all_inst_iter);
        let calls = instructions.filter(|i| i.class.opcode == Op::FunctionCall);
        open.extend(calls.filter_map(|call| call.operands.first()?.id_ref_any()));
    }
    module.functions.retain(|function| function.def_id().is_some_and(|id| called.contains(&id)));
}

/// Takes out resources, and values from and for other stages, that no function names, and every word about what is not
/// there any more.
fn drop_unread(module: &mut Module) {
    let read: HashSet<Word> = module
        .functions
        .iter()
        .flat_map(Function::all_inst_iter)
        .flat_map(|i| i.operands.iter().filter_map(Operand::id_ref_any))
        .collect();
    module.types_global_values.retain(|global| {
        let resource = matches!(
            global.operands.first(),
            Some(Operand::StorageClass(
                StorageClass::Uniform
                    | StorageClass::UniformConstant
                    | StorageClass::StorageBuffer
                    | StorageClass::PushConstant
                    | StorageClass::Input
                    | StorageClass::Output
            ))
        );
        let variable = global.class.opcode == Op::Variable;
        !(variable && resource) || global.result_id.is_some_and(|id| read.contains(&id))
    });
    let functions = module.functions.iter().flat_map(Function::all_inst_iter);
    let present: HashSet<Word> = module
        .types_global_values
        .iter()
        .chain(functions)
        .chain(&module.ext_inst_imports)
        .filter_map(|i| i.result_id)
        .collect();
    let is_there = |operand: Option<&Operand>| {
        operand.and_then(Operand::id_ref_any).is_none_or(|id| present.contains(&id))
    };
    module.debug_names.retain(|name| is_there(name.operands.first()));
    module.annotations.retain(|annotation| is_there(annotation.operands.first()));
    for entry in &mut module.entry_points {
        let mut place = 0;
        entry.operands.retain(|operand| {
            place += 1;
            // Model, function and name come first, then its interface.
            place <= 3 || is_there(Some(operand))
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_decided_by_one_operand_where_that_is_enough() {
        let known = Known::from([(1, 0), (2, 1), (3, 7)]);
        let of = |op, ids: &[Word]| {
            evaluate(op, &ids.iter().map(|id| Operand::IdRef(*id)).collect::<Vec<_>>(), &known)
        };
        assert_eq!((of(Op::LogicalAnd, &[1, 9]), of(Op::LogicalAnd, &[9, 2])), (Some(0), None));
        assert_eq!((of(Op::LogicalOr, &[9, 2]), of(Op::LogicalOr, &[9, 1])), (Some(1), None));
        assert_eq!((of(Op::LogicalNot, &[1]), of(Op::LogicalNot, &[9])), (Some(1), None));
        assert_eq!((of(Op::UGreaterThan, &[3, 1]), of(Op::UGreaterThan, &[1, 1])), (Some(1), Some(0)));
        assert_eq!((of(Op::Select, &[2, 3, 9]), of(Op::Select, &[1, 3, 9])), (Some(7), None));
        assert_eq!((of(Op::IEqual, &[3, 3]), of(Op::IAdd, &[3, 3])), (Some(1), None));
        assert_eq!((of(Op::Phi, &[3, 9]), of(Op::Phi, &[3, 8, 3, 9])), (Some(7), None));
        assert!(trimmed(&[1, 2, 3], &SpecializationConstants::new()).is_err());
    }
}
