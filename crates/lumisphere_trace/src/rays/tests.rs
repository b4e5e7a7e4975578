//! What shows only from within: instruction sets, the stack, the shape of the tree.
#![allow(clippy::unwrap_used)]

use super::block::BLOCK;
use super::node::Child;
use super::stack::{Entry, INLINE, Stack};
use super::{Ray, TriangleBvh};
use fearless_simd::{Level, Simd};

/// Every instruction set of this machine, least first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![Level::fallback(), Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse4_2().map(Simd::level));
        levels.extend(best.as_avx2().map(Simd::level));
        levels.extend(best.as_avx512().map(Simd::level));
    }
    levels.push(best);
    levels
}

/// Points of a lattice by an additive recurrence, in [-1, 1]³.
fn point(i: usize) -> [f32; 3] {
    [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|a: f64| ((a * i as f64).fract() * 2.0 - 1.0) as f32)
}

fn soup(count: usize, size: f32) -> TriangleBvh {
    let corner = |i: usize| [0, 1, 2].map(|k| point(i / 3)[k] + size * point(7 * i + 3)[k]);
    let positions: Vec<[f32; 3]> = (0..3 * count).map(corner).collect();
    let triangles: Vec<[u32; 3]> = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleBvh::build(&positions, &triangles).unwrap()
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut tree = soup(5000, 0.06);
    let rays: Vec<Ray> = (0..4000)
        .map(|i| Ray { origin: point(i), direction: [0, 1, 2].map(|k| point(i + 9999)[(k + i) % 3]) })
        .collect();
    let mut answers = Vec::new();
    for level in levels() {
        tree.level = level;
        answers.push(rays.iter().map(|r| (tree.closest_hit(r, 4.0), tree.occluded(r, 0.5))).collect::<Vec<_>>());
    }
    let hits = answers[0].iter().filter(|a| a.0.is_some()).count();
    assert!(hits > 2000 && hits < 4000, "{hits}");
    for (level, answer) in levels().iter().zip(&answers) {
        assert!(*answer == answers[0], "{level:?}");
    }
}

#[test]
fn a_stack_returns_what_it_was_given_however_deep() {
    for count in [0, 1, INLINE - 1, INLINE, INLINE + 1, 500] {
        let mut stack = Stack::new();
        (0..count).for_each(|i| stack.push(Entry::new(i as f32, Child::node(i))));
        for i in (0..count).rev() {
            let entry = stack.pop().unwrap();
            assert_eq!((entry.near(), entry.child()), (i as f32, Child::node(i)));
        }
        assert!(stack.pop().is_none());
    }
}

/// Each triangle lies in one block, and in the boxes of all nodes above.
#[test]
fn boxes_hold_their_triangles() {
    for count in [1, 2, 5, 100, 3000] {
        let tree = soup(count, 0.1);
        let mut seen = vec![0; count];
        let everything = [[f32::NEG_INFINITY, f32::INFINITY]; 3];
        let mut waiting = vec![(tree.root, everything)];
        while let Some((child, bounds)) = waiting.pop() {
            if child == Child::EMPTY {
                continue;
            }
            if !child.is_block() {
                let node = &tree.nodes[child.index()];
                for lane in 0..8 {
                    let planes = [0, 1, 2].map(|axis| [node.planes[axis][0][lane], node.planes[axis][1][lane]]);
                    waiting.push((node.children[lane], planes));
                }
                continue;
            }
            let block = &tree.blocks[child.index()];
            for lane in (0..BLOCK).filter(|lane| child.lanes() >> lane & 1 == 1) {
                seen[block.triangles[lane] as usize] += 1;
                for axis in 0..3 {
                    for vertex in 0..3 {
                        let x = block.vertices[axis][vertex][lane];
                        assert!(bounds[axis][0] <= x && x <= bounds[axis][1]);
                    }
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1), "{count}");
    }
}
