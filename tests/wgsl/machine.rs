//! Runs a shader's functions by its intermediate representation, with an arithmetic of the caller.
//!
//! It knows what the shaders of this crate use, and panics at anything else.

use naga::{
    Arena, Block, Expression, Function, Handle, Literal, Module, ScalarKind, Statement, TypeInner,
    UnaryOperator,
};

use super::arithmetic::Arithmetic;
use super::value::Value::{self, Bool, F32, I32, Many, Pointer, U32};
use super::value::{Place, composed, converted, each, element};

pub struct Machine<'a> {
    pub module: &'a Module,
    pub arithmetic: Arithmetic,
    /// The one global variable.
    pub global: Value,
}

/// A call of a function.
pub struct Frame<'f> {
    pub function: &'f Function,
    arguments: Vec<Value>,
    locals: Vec<Value>,
    values: Vec<Option<Value>>,
}

impl<'a> Machine<'a> {
    pub fn call(&mut self, name: &str, arguments: &[Value]) -> Value {
        let mut functions = self.module.functions.iter();
        let (_, function) = functions
            .find(|(_, function)| function.name.as_deref() == Some(name))
            .unwrap_or_else(|| panic!("no function {name}"));
        self.run(function, arguments.to_vec())
    }

    fn run(&mut self, function: &'a Function, arguments: Vec<Value>) -> Value {
        let mut frame = Frame {
            function,
            arguments,
            locals: Vec::new(),
            values: vec![None; function.expressions.len()],
        };
        for (_, local) in function.local_variables.iter() {
            let value = local.init.map(|init| self.value(&mut frame, init));
            frame
                .locals
                .push(value.unwrap_or_else(|| self.zero(local.ty)));
        }
        self.block(&mut frame, &function.body)
            .expect("a function that returns")
    }

    /// Runs the statements of a block, and returns what they return.
    fn block(&mut self, frame: &mut Frame<'a>, block: &'a Block) -> Option<Value> {
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        frame.values[expression.index()] = None;
                        let value = self.computed(frame, expression);
                        frame.values[expression.index()] = Some(value);
                    }
                }
                Statement::Block(block) => {
                    if let Some(value) = self.block(frame, block) {
                        return Some(value);
                    }
                }
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let is_true = self.value(frame, *condition).bool();
                    if let Some(value) = self.block(frame, if is_true { accept } else { reject }) {
                        return Some(value);
                    }
                }
                Statement::Store { pointer, value } => {
                    let value = self.value(frame, *value);
                    match self.value(frame, *pointer) {
                        Pointer(Place::Local(i), path) => *frame.locals[i].at_mut(&path) = value,
                        other => panic!("a store to {other:?}"),
                    }
                }
                Statement::Call {
                    function,
                    arguments,
                    result,
                } => {
                    let arguments = arguments.iter().map(|i| self.value(frame, *i)).collect();
                    let returned = self.run(&self.module.functions[*function], arguments);
                    if let Some(result) = result {
                        frame.values[result.index()] = Some(returned);
                    }
                }
                Statement::Return { value: Some(value) } => return Some(self.value(frame, *value)),
                other => panic!("{other:?} is unknown to this machine"),
            }
        }
        None
    }

    pub fn value(&mut self, frame: &mut Frame<'a>, expression: Handle<Expression>) -> Value {
        match &frame.values[expression.index()] {
            Some(value) => value.clone(),
            None => self.computed(frame, expression),
        }
    }

    fn computed(&mut self, frame: &mut Frame<'a>, expression: Handle<Expression>) -> Value {
        match &frame.function.expressions[expression] {
            Expression::FunctionArgument(i) => frame.arguments[*i as usize].clone(),
            Expression::LocalVariable(local) => Pointer(Place::Local(local.index()), Vec::new()),
            Expression::GlobalVariable(_) => Pointer(Place::Global, Vec::new()),
            Expression::Load { pointer } => match self.value(frame, *pointer) {
                Pointer(Place::Local(i), path) => frame.locals[i].at(&path).clone(),
                Pointer(Place::Global, path) => self.global.at(&path).clone(),
                other => panic!("a load from {other:?}"),
            },
            Expression::Access { base, index } => {
                let index = self.value(frame, *index).u32() as usize;
                element(self.value(frame, *base), index)
            }
            Expression::AccessIndex { base, index } => {
                element(self.value(frame, *base), *index as usize)
            }
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|i| self.value(frame, *i)).collect();
                composed(&self.module.types[*ty].inner, parts)
            }
            Expression::Splat { size, value } => {
                Many(vec![self.value(frame, *value); *size as usize])
            }
            Expression::Swizzle {
                size,
                vector,
                pattern,
            } => {
                let vector = self.value(frame, *vector);
                let chosen = pattern[..*size as usize].iter();
                Many(
                    chosen
                        .map(|i| vector.component(*i as usize).clone())
                        .collect(),
                )
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let parts = [condition, accept, reject].map(|i| self.value(frame, *i));
                match &parts {
                    [Bool(is_true), accept, reject] => {
                        if *is_true { accept } else { reject }.clone()
                    }
                    _ => each(&parts, |parts| {
                        parts[if parts[0].bool() { 1 } else { 2 }].clone()
                    }),
                }
            }
            Expression::Unary { op, expr } => {
                let value = self.value(frame, *expr);
                each(&[value], |value| match (op, value[0]) {
                    (UnaryOperator::Negate, F32(x)) => F32(-x),
                    (UnaryOperator::LogicalNot, Bool(x)) => Bool(!x),
                    other => panic!("{other:?} is unknown to this machine"),
                })
            }
            Expression::Binary { op, left, right } => {
                self.binary(frame, expression, *op, [*left, *right])
            }
            Expression::Relational { fun, argument } => {
                let list = self.value(frame, *argument);
                let mut list = list.many().iter().map(Value::bool);
                Bool(match fun {
                    naga::RelationalFunction::All => list.all(|x| x),
                    naga::RelationalFunction::Any => list.any(|x| x),
                    other => panic!("{other:?} is unknown to this machine"),
                })
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                ..
            } => {
                let arguments = [Some(*arg), *arg1, *arg2].into_iter().flatten();
                let arguments: Vec<_> = arguments.map(|i| self.value(frame, i)).collect();
                self.math(*fun, &arguments)
            }
            Expression::As {
                expr,
                kind,
                convert,
            } => {
                let value = self.value(frame, *expr);
                each(&[value], |value| {
                    converted(value[0], *kind, convert.is_some())
                })
            }
            other => self.constant(other, &frame.function.expressions),
        }
    }

    /// An expression that may also stand outside of functions.
    fn constant(&self, expression: &Expression, arena: &Arena<Expression>) -> Value {
        let part = |i: Handle<Expression>| self.constant(&arena[i], arena);
        match expression {
            Expression::Literal(Literal::F32(x)) => F32(*x),
            Expression::Literal(Literal::U32(x)) => U32(*x),
            Expression::Literal(Literal::I32(x)) => I32(*x),
            Expression::Literal(Literal::Bool(x)) => Bool(*x),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Constant(constant) => {
                let arena = &self.module.global_expressions;
                self.constant(&arena[self.module.constants[*constant].init], arena)
            }
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|i| part(*i)).collect();
                composed(&self.module.types[*ty].inner, parts)
            }
            Expression::Splat { size, value } => Many(vec![part(*value); *size as usize]),
            other => panic!("{other:?} is unknown to this machine"),
        }
    }

    fn zero(&self, ty: Handle<naga::Type>) -> Value {
        let scalar = |kind| match kind {
            ScalarKind::Float => F32(0.0),
            ScalarKind::Uint => U32(0),
            ScalarKind::Sint => I32(0),
            _ => Bool(false),
        };
        match &self.module.types[ty].inner {
            TypeInner::Scalar(kind) => scalar(kind.kind),
            TypeInner::Vector { size, scalar: kind } => {
                Many(vec![scalar(kind.kind); *size as usize])
            }
            TypeInner::Matrix { columns, rows, .. } => {
                Many(vec![
                    Many(vec![F32(0.0); *rows as usize]);
                    *columns as usize
                ])
            }
            TypeInner::Struct { members, .. } => {
                Many(members.iter().map(|member| self.zero(member.ty)).collect())
            }
            other => panic!("{other:?} is unknown to this machine"),
        }
    }
}
