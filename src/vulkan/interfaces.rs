//! What a shader reads and writes beside itself, by numbers: whether a pipeline has it all.

use super::descriptors::DescriptorLayout;
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::{BTreeMap, BTreeSet};

/// Words before a module's first instruction.
const HEADER_WORDS: usize = 5;

/// Numbers of a shader's resources and values. Trimmed words declare no more than is used.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Interfaces {
    /// Set and binding.
    resources: BTreeSet<(u32, u32)>,
    /// Location and component, of the stage before.
    inputs: BTreeSet<(u32, u32)>,
    /// Likewise, for the stage after.
    outputs: BTreeSet<(u32, u32)>,
}

impl Interfaces {
    /// Those that SPIR-V words declare.
    pub fn of(words: &[u32]) -> Self {
        let mut numbers: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut variables = Vec::new();
        let mut rest = words.get(HEADER_WORDS..).unwrap_or_default();
        while let Some(&head) = rest.first() {
            let (instruction, after) = rest.split_at(((head >> 16).max(1) as usize).min(rest.len()));
            match instruction {
                [_, id, decoration, number] if head & 0xffff == Op::Decorate as u32 => {
                    numbers.insert((*id, *decoration), *number);
                }
                [_, _, id, class, ..] if head & 0xffff == Op::Variable as u32 => {
                    variables.push((*id, *class))
                }
                _ => (),
            }
            rest = after;
        }
        let mut found = Self::default();
        for (id, class) in variables {
            let number = |decoration: Decoration| numbers.get(&(id, decoration as u32)).copied();
            if let Some(location) = number(Decoration::Location) {
                let place = (location, number(Decoration::Component).unwrap_or(0));
                let way =
                    if class == StorageClass::Input as u32 { &mut found.inputs } else { &mut found.outputs };
                way.insert(place);
            } else if let Some(binding) = number(Decoration::Binding) {
                found.resources.insert((number(Decoration::DescriptorSet).unwrap_or(0), binding));
            }
        }
        found
    }

    /// What of it is not there, of sets with these layouts behind the stage `before`.
    pub fn lacks(&self, layouts: &[&DescriptorLayout], before: Option<&Self>) -> Option<String> {
        let bound = |set: u32, binding: u32| {
            let layout = layouts.get(set as usize);
            layout.is_some_and(|layout| layout.bindings().iter().any(|made| made.binding == binding))
        };
        if let Some((set, binding)) = self.resources.iter().find(|(set, binding)| !bound(*set, *binding)) {
            return Some(format!("reads set {set}, binding {binding}, which this scene does not need"));
        }
        let before = before?;
        let (location, _) = self.inputs.iter().find(|place| !before.outputs.contains(place))?;
        Some(format!("reads location {location}, which the stage before does not write in this scene"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A variable: its id, its class and what decorates it.
    type Declared<'a> = (u32, StorageClass, &'a [(Decoration, u32)]);

    fn words(variables: &[Declared<'_>]) -> Vec<u32> {
        let mut words = vec![0; HEADER_WORDS];
        for (id, _, decorations) in variables {
            for (decoration, number) in *decorations {
                words.extend([4 << 16 | Op::Decorate as u32, *id, *decoration as u32, *number]);
            }
        }
        for (id, class, _) in variables {
            words.extend([4 << 16 | Op::Variable as u32, 99, *id, *class as u32]);
        }
        words
    }

    #[test]
    fn what_is_read_must_be_bound_and_written() {
        use Decoration::{Binding, Component, DescriptorSet, Location};
        let reads = Interfaces::of(&words(&[
            (1, StorageClass::Input, &[(Location, 3)]),
            (2, StorageClass::Input, &[(Location, 3), (Component, 2)]),
            (3, StorageClass::Output, &[(Location, 0)]),
        ]));
        let writes = |components: &[u32]| {
            let mut found = Interfaces::default();
            found.outputs.extend(components.iter().map(|component| (3, *component)));
            found
        };
        assert_eq!(reads.lacks(&[], Some(&writes(&[0, 2]))), None);
        assert!(reads.lacks(&[], Some(&writes(&[0]))).is_some_and(|why| why.contains("location 3")));
        assert_eq!(reads.lacks(&[], None), None, "of the first stage nothing is before");
        let bound =
            Interfaces::of(&words(&[(1, StorageClass::Uniform, &[(DescriptorSet, 1), (Binding, 4)])]));
        assert!(bound.lacks(&[], None).is_some_and(|why| why.contains("set 1, binding 4")));
        // Cut short, it is read as far as it goes.
        let all = words(&[(1, StorageClass::Input, &[(Location, 3)])]);
        assert_eq!(Interfaces::of(&all[..all.len() - 1]), Interfaces::default());
        assert_eq!(Interfaces::of(&[]), Interfaces::default());
    }
}
