//! What the machine computes: sums, products and functions.

use naga::{BinaryOperator as Op, Expression, Handle, MathFunction as Function};

use super::machine::{Frame, Machine};
use super::value::Value::{self, Bool, F32, Many, U32};
use super::value::{each, number};

impl<'a> Machine<'a> {
    pub fn binary(
        &mut self,
        frame: &mut Frame<'a>,
        expression: Handle<Expression>,
        op: Op,
        sides: [Handle<Expression>; 2],
    ) -> Value {
        let [left, right] = sides.map(|side| self.value(frame, side));
        let is_float = |value: &Value| {
            matches!(value, F32(_)) || matches!(value, Many(list) if matches!(list[0], F32(_)))
        };
        if op == Op::Multiply && left.is_matrix() {
            return self.matrix_product(left.many(), &right);
        }
        if is_float(&left) || is_float(&right) {
            match op {
                Op::Add | Op::Subtract => {
                    let mut terms = Vec::new();
                    self.terms(frame, expression, false, &mut terms);
                    return each(&terms, |terms| {
                        F32(self.arithmetic.sum(terms.iter().copied().map(number)))
                    });
                }
                Op::Multiply | Op::Divide => {
                    let mut parts = [Vec::new(), Vec::new()];
                    self.factors(frame, expression, 0, &mut parts);
                    let [factors, divisors] = parts;
                    let all = [factors.clone(), divisors].concat();
                    return each(&all, |all| {
                        let numbers = |list: &[&Value]| list.iter().copied().map(number).collect();
                        let (factors, divisors) = all.split_at(factors.len());
                        F32(self.arithmetic.product(numbers(factors), numbers(divisors)))
                    });
                }
                _ => {}
            }
        }
        each(&[left, right], |sides| exact_binary(op, sides[0], sides[1]))
    }

    /// The terms of a sum, of which each may be a sum. Any order is allowed.
    fn terms(
        &mut self,
        frame: &mut Frame<'a>,
        expression: Handle<Expression>,
        is_negative: bool,
        terms: &mut Vec<Value>,
    ) {
        if let Expression::Binary {
            op: op @ (Op::Add | Op::Subtract),
            left,
            right,
        } = frame.function.expressions[expression]
        {
            self.terms(frame, left, is_negative, terms);
            self.terms(frame, right, is_negative != (op == Op::Subtract), terms);
            return;
        }
        let value = self.value(frame, expression);
        terms.push(if is_negative {
            each(&[value], |value| F32(-number(value[0])))
        } else {
            value
        });
    }

    /// The factors and the divisors of a product, of which each may be a product. Any order is allowed.
    fn factors(
        &mut self,
        frame: &mut Frame<'a>,
        expression: Handle<Expression>,
        side: usize,
        parts: &mut [Vec<Value>; 2],
    ) {
        match frame.function.expressions[expression] {
            Expression::Binary {
                op: op @ (Op::Multiply | Op::Divide),
                left,
                right,
            } if !self.value(frame, left).is_matrix() => {
                self.factors(frame, left, side, parts);
                self.factors(
                    frame,
                    right,
                    if op == Op::Divide { 1 - side } else { side },
                    parts,
                );
            }
            _ => {
                let value = self.value(frame, expression);
                parts[side].push(value);
            }
        }
    }

    /// A matrix, given by its columns, times a vector or a matrix.
    fn matrix_product(&mut self, columns: &[Value], right: &Value) -> Value {
        if right.is_matrix() {
            let products = right
                .many()
                .iter()
                .map(|column| self.matrix_product(columns, column));
            return Many(products.collect());
        }
        let row = |i: usize| {
            Many(
                columns
                    .iter()
                    .map(|column| column.component(i).clone())
                    .collect(),
            )
        };
        let rows: Vec<_> = (0..columns[0].many().len()).map(row).collect();
        Many(rows.iter().map(|row| F32(self.dot(row, right))).collect())
    }

    fn dot(&mut self, a: &Value, b: &Value) -> f32 {
        let pairs = a.many().iter().zip(b.many());
        let products: Vec<_> = pairs
            .map(|(a, b)| self.arithmetic.product(vec![a.f32(), b.f32()], vec![]))
            .collect();
        self.arithmetic.sum(products)
    }

    fn length(&mut self, v: &Value) -> f32 {
        let squared = self.dot(v, v);
        self.arithmetic.square_root(squared)
    }

    pub fn math(&mut self, function: Function, arguments: &[Value]) -> Value {
        match function {
            Function::Dot => F32(self.dot(&arguments[0], &arguments[1])),
            Function::Length => F32(self.length(&arguments[0])),
            Function::Normalize => {
                let length = self.length(&arguments[0]);
                each(&arguments[..1], |x| {
                    F32(self.arithmetic.product(vec![number(x[0])], vec![length]))
                })
            }
            Function::Cross => {
                let [a, b] = [0, 1].map(|i| arguments[i].many());
                let component = |i: usize| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let products = [(j, k, 1.0), (k, j, -1.0)].map(|(j, k, sign)| {
                        self.arithmetic
                            .product(vec![sign * a[j].f32(), b[k].f32()], vec![])
                    });
                    F32(self.arithmetic.sum(products))
                };
                Many((0..3).map(component).collect())
            }
            Function::Transpose => {
                let columns = arguments[0].many();
                let row = |i| {
                    Many(
                        columns
                            .iter()
                            .map(|column| column.component(i).clone())
                            .collect(),
                    )
                };
                Many((0..columns[0].many().len()).map(row).collect())
            }
            _ => each(arguments, |x| match (function, x) {
                (Function::Sqrt, [F32(x)]) => F32(self.arithmetic.square_root(*x)),
                (Function::InverseSqrt, [F32(x)]) => F32(self.arithmetic.inverse_square_root(*x)),
                (Function::Abs, [F32(x)]) => F32(x.abs()),
                (Function::Floor, [F32(x)]) => F32(x.floor()),
                (Function::Min, [F32(x), F32(y)]) => F32(x.min(*y)),
                (Function::Max, [F32(x), F32(y)]) => F32(x.max(*y)),
                (Function::Clamp, [F32(x), F32(low), F32(high)]) => F32(x.max(*low).min(*high)),
                (Function::CountLeadingZeros, [U32(x)]) => U32(x.leading_zeros()),
                (Function::ReverseBits, [U32(x)]) => U32(x.reverse_bits()),
                other => panic!("{other:?} is unknown to this machine"),
            }),
        }
    }
}

/// An operation that does not round.
fn exact_binary(op: Op, left: &Value, right: &Value) -> Value {
    match (left, op, right) {
        (F32(x), Op::Less, F32(y)) => Bool(x < y),
        (F32(x), Op::LessEqual, F32(y)) => Bool(x <= y),
        (F32(x), Op::Greater, F32(y)) => Bool(x > y),
        (F32(x), Op::GreaterEqual, F32(y)) => Bool(x >= y),
        (U32(x), Op::Greater, U32(y)) => Bool(x > y),
        (U32(x), Op::GreaterEqual, U32(y)) => Bool(x >= y),
        (U32(x), Op::Equal, U32(y)) => Bool(x == y),
        (U32(x), Op::Add, U32(y)) => U32(x.wrapping_add(*y)),
        (U32(x), Op::Subtract, U32(y)) => U32(x.wrapping_sub(*y)),
        (U32(x), Op::Multiply, U32(y)) => U32(x.wrapping_mul(*y)),
        (U32(x), Op::Divide, U32(y)) => U32(x / y),
        (U32(x), Op::Modulo, U32(y)) => U32(x % y),
        (U32(x), Op::And, U32(y)) => U32(x & y),
        (U32(x), Op::InclusiveOr, U32(y)) => U32(x | y),
        (U32(x), Op::ExclusiveOr, U32(y)) => U32(x ^ y),
        (U32(x), Op::ShiftLeft, U32(y)) => U32(x << y),
        (U32(x), Op::ShiftRight, U32(y)) => U32(x >> y),
        other => panic!("{other:?} is unknown to this machine"),
    }
}
