//! The values that a shader computes with.

use naga::{ScalarKind, TypeInner};

use Value::{Bool, F32, Many, Pointer, U32};

/// A value of WGSL. Vectors, columns of matrices, arrays and structures are lists.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    F32(f32),
    U32(u32),
    I32(i32),
    Bool(bool),
    Many(Vec<Value>),
    /// A local variable, or a global one, and the places in it.
    Pointer(Place, Vec<usize>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    Local(usize),
    Global,
}

impl From<f32> for Value {
    fn from(x: f32) -> Self {
        F32(x)
    }
}

impl From<u32> for Value {
    fn from(x: u32) -> Self {
        U32(x)
    }
}

impl<T: Into<Value> + Copy, const N: usize> From<[T; N]> for Value {
    fn from(list: [T; N]) -> Self {
        Many(list.map(Into::into).to_vec())
    }
}

impl From<Vec<Value>> for Value {
    fn from(list: Vec<Value>) -> Self {
        Many(list)
    }
}

impl Value {
    pub fn f32(&self) -> f32 {
        match self {
            F32(x) => *x,
            other => panic!("{other:?} is no f32"),
        }
    }

    pub fn u32(&self) -> u32 {
        match self {
            U32(x) => *x,
            other => panic!("{other:?} is no u32"),
        }
    }

    pub fn bool(&self) -> bool {
        match self {
            Bool(x) => *x,
            other => panic!("{other:?} is no bool"),
        }
    }

    pub fn many(&self) -> &[Value] {
        match self {
            Many(list) => list,
            other => panic!("{other:?} is no list"),
        }
    }

    pub fn is_matrix(&self) -> bool {
        matches!(self, Many(list) if matches!(list[0], Many(_)))
    }

    pub fn at(&self, path: &[usize]) -> &Value {
        path.iter().fold(self, |value, i| &value.many()[*i])
    }

    pub fn at_mut(&mut self, path: &[usize]) -> &mut Value {
        path.iter().fold(self, |value, i| match value {
            Many(list) => &mut list[*i],
            other => panic!("{other:?} is no list"),
        })
    }

    /// The component of a vector, or a scalar itself.
    pub fn component(&self, i: usize) -> &Value {
        match self {
            Many(list) => &list[i],
            scalar => scalar,
        }
    }
}

/// Applies `function` to each component of `values`, of which scalars are as long as the vectors.
pub fn each(values: &[Value], mut function: impl FnMut(&[&Value]) -> Value) -> Value {
    let length = values.iter().find_map(|value| match value {
        Many(list) => Some(list.len()),
        _ => None,
    });
    let Some(length) = length else {
        return function(&values.iter().collect::<Vec<_>>());
    };
    let component = |i| {
        function(
            &values
                .iter()
                .map(|value| value.component(i))
                .collect::<Vec<_>>(),
        )
    };
    Many((0..length).map(component).collect())
}

pub fn number(value: &Value) -> f32 {
    value.f32()
}

pub fn element(base: Value, index: usize) -> Value {
    match base {
        Pointer(place, mut path) => {
            path.push(index);
            Pointer(place, path)
        }
        list => list.many()[index].clone(),
    }
}

/// A vector may be composed of shorter ones.
pub fn composed(ty: &TypeInner, parts: Vec<Value>) -> Value {
    if !matches!(ty, TypeInner::Vector { .. }) {
        return Many(parts);
    }
    let flat = parts.into_iter().flat_map(|part| match part {
        Many(list) => list,
        scalar => vec![scalar],
    });
    Many(flat.collect())
}

/// A conversion, exact or not at all, or the same bits.
pub fn converted(value: &Value, kind: ScalarKind, is_conversion: bool) -> Value {
    match (value, kind, is_conversion) {
        (U32(x), ScalarKind::Float, false) => F32(f32::from_bits(*x)),
        (U32(x), ScalarKind::Float, true) => {
            assert!(*x <= 1 << 24, "{x} may be rounded either way");
            F32(*x as f32)
        }
        (F32(x), ScalarKind::Uint, true) => U32(*x as u32),
        other => panic!("{other:?} is unknown to this machine"),
    }
}
