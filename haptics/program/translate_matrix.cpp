// Vector algebra out of elementwise operations.

#include "haptics/program/meaning.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv/unified1/GLSL.std.450.h>

#include <array>

namespace touchstone::program {

namespace {

using enum Operation;
constexpr Kind kReal = Kind::Float;

/// A float matrix: columns of `rows` components, one after the other.
struct Matrix {
    uint16_t first = 0;
    uint32_t columns = 0, rows = 0;
    [[nodiscard]] uint16_t entry(size_t column, size_t row) const {
        return at16(first + column * rows + row);
    }
    [[nodiscard]] uint16_t column(size_t i) const { return entry(i, 0); }
};

Matrix matrixOf(const Meaning& t, uint32_t type, uint16_t first) {
    const SpirvType& matrix = t.types[type];
    if (matrix.kind != Kind::Matrix)
        refuseDamaged("a matrix is expected");
    return {first, matrix.count, t.types[matrix.element].registers};
}

Matrix matrixOf(const Meaning& t, const SpirvInstruction& at, size_t operand) {
    const Value& v = t.operand(at, operand);
    return matrixOf(t, v.type, v.first);
}

/// Rows of a matrix, as columns.
Matrix transposed(Meaning& t, const Matrix& m) {
    const Matrix to{t.build.allocate(size_t{m.columns} * m.rows), m.rows, m.columns};
    for (size_t c = 0; c < m.columns; ++c)
        for (size_t r = 0; r < m.rows; ++r)
            t.build.move(to.entry(r, c), m.entry(c, r), 1);
    return to;
}

/// to = m v: the sum of v's components times m's columns.
void timesVector(Meaning& t, const Matrix& m, uint16_t v, uint16_t to) {
    t.build.emit({Scale, at16(m.rows), to, m.column(0), v});
    for (size_t c = 1; c < m.columns; ++c) {
        const uint16_t part = t.build.result(Scale, m.rows, m.column(c), at16(v + c));
        t.build.emit({FAdd, at16(m.rows), to, to, part});
    }
}

/// to = v m: v dot each of m's columns.
void vectorTimes(Meaning& t, uint16_t v, const Matrix& m, uint16_t to) {
    for (size_t c = 0; c < m.columns; ++c)
        t.build.emit({Dot, at16(m.rows), at16(to + c), v, m.column(c)});
}

void multiplyMatrices(Meaning& t, const SpirvInstruction& at) {
    const Matrix a = matrixOf(t, at, 0), b = matrixOf(t, at, 1), shape = matrixOf(t, at.type, 0);
    if (a.columns != b.rows || shape.columns != b.columns || shape.rows != a.rows)
        refuseDamaged("matrices have wrong sizes");
    const Matrix to{t.build.allocate(size_t{b.columns} * a.rows), b.columns, a.rows};
    for (size_t c = 0; c < b.columns; ++c)
        timesVector(t, a, b.column(c), to.column(c));
    t.define(at, to.first);
}

void matrixWithVector(Meaning& t, const SpirvInstruction& at) {
    const bool vectorFirst = at.code == spv::OpVectorTimesMatrix;
    const Matrix m = matrixOf(t, at, vectorFirst ? 1 : 0);
    const uint16_t v = t.operand(at, vectorFirst ? 0 : 1, kReal, vectorFirst ? m.rows : m.columns);
    const uint32_t size = t.resultSize(at, kReal);
    if (size != (vectorFirst ? m.columns : m.rows))
        refuseDamaged("a result has a wrong type");
    const uint16_t to = t.build.allocate(size);
    if (vectorFirst)
        vectorTimes(t, v, m, to);
    else
        timesVector(t, m, v, to);
    t.define(at, to);
}

void outerProduct(Meaning& t, const SpirvInstruction& at) {
    const Matrix shape = matrixOf(t, at.type, 0);
    const uint16_t column = t.operand(at, 0, kReal, shape.rows), row = t.operand(at, 1, kReal, shape.columns);
    const uint16_t to = t.build.allocate(size_t{shape.columns} * shape.rows);
    for (size_t c = 0; c < shape.columns; ++c)
        t.build.emit({Scale, at16(shape.rows), at16(to + c * shape.rows), column, at16(row + c)});
    t.define(at, to);
}

/// The determinant of the rows and columns that are left, by its first column (Laplace).
uint16_t minorOf(Meaning& t, const Matrix& m, unsigned columns, unsigned rows) {
    unsigned column = 0;
    while ((columns >> column & 1u) == 0)
        ++column;
    const unsigned others = columns & ~(1u << column);
    std::optional<uint16_t> sum;
    bool negative = false;
    for (unsigned row = 0; row < m.rows; ++row) {
        if ((rows >> row & 1u) == 0)
            continue;
        uint16_t term = m.entry(column, row);
        if (others != 0)
            term = t.build.result(FMul, 1, term, minorOf(t, m, others, rows & ~(1u << row)));
        sum = sum ? t.build.result(negative ? FSub : FAdd, 1, *sum, term) : term;
        negative = !negative;
    }
    return sum.value_or(0);
}

Matrix squareOf(const Meaning& t, const SpirvInstruction& at) {
    const Matrix m = matrixOf(t, at, 2);
    if (m.columns != m.rows)
        refuseDamaged("a matrix is not square");
    return m;
}

/// The cofactors over the determinant.
void inverse(Meaning& t, const SpirvInstruction& at) {
    const Matrix m = squareOf(t, at), shape = matrixOf(t, at.type, 0);
    if (shape.columns != m.columns || shape.rows != m.rows)
        refuseDamaged("a result has a wrong type");
    const unsigned all = (1u << m.rows) - 1u;
    const uint16_t determinant = minorOf(t, m, all, all);
    const Matrix to{t.build.allocate(size_t{m.columns} * m.rows), m.columns, m.rows};
    for (unsigned c = 0; c < m.columns; ++c)
        for (unsigned r = 0; r < m.rows; ++r) {
            uint16_t cofactor = minorOf(t, m, all & ~(1u << r), all & ~(1u << c));
            if ((c + r) % 2 == 1)
                cofactor = t.build.result(FNegate, 1, cofactor);
            t.build.emit({FDiv, 1, to.entry(c, r), cofactor, determinant});
        }
    t.define(at, to.first);
}

uint16_t lengthOf(Meaning& t, uint16_t x, size_t size) {
    if (size == 1)
        return t.build.result(FAbs, 1, x);
    return t.build.result(Sqrt, 1, t.build.result(Dot, size, x, x, 0, 1));
}

void cross(Meaning& t, const SpirvInstruction& at) {
    const uint16_t a = t.operand(at, 2, kReal, 3), b = t.operand(at, 3, kReal, 3);
    if (t.resultSize(at, kReal) != 3)
        refuseDamaged("a result has a wrong type");
    const uint16_t to = t.build.allocate(3);
    for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const uint16_t plus = t.build.result(FMul, 1, at16(a + j), at16(b + k));
        const uint16_t minus = t.build.result(FMul, 1, at16(a + k), at16(b + j));
        t.build.emit({FSub, 1, at16(to + i), plus, minus});
    }
    t.define(at, to);
}

/// I - 2 (N . I) N
void reflect(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.resultSize(at, kReal);
    const uint16_t i = t.operand(at, 2, kReal, size), n = t.operand(at, 3, kReal, size);
    const uint16_t dot = t.build.result(Dot, size, n, i, 0, 1);
    const uint16_t twice = t.build.result(FAdd, 1, dot, dot);
    t.define(at, t.build.result(FSub, size, i, t.build.result(Scale, size, n, twice)));
}

/// eta I - (eta (N . I) + sqrt(k)) N with k = 1 - eta^2 (1 - (N . I)^2); 0 where k < 0.
void refract(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.resultSize(at, kReal);
    const uint16_t i = t.operand(at, 2, kReal, size), n = t.operand(at, 3, kReal, size),
                   eta = t.operand(at, 4, kReal, 1), one = t.number(1.0f);
    const uint16_t dot = t.build.result(Dot, size, n, i, 0, 1);
    const uint16_t sine2 = t.build.result(FSub, 1, one, t.build.result(FMul, 1, dot, dot));
    const uint16_t bent = t.build.result(FMul, 1, t.build.result(FMul, 1, eta, eta), sine2);
    const uint16_t k = t.build.result(FSub, 1, one, bent);
    const uint16_t root = t.build.result(Sqrt, 1, t.build.result(FMax, 1, k, t.number(0.0f)));
    const uint16_t along = t.build.result(FAdd, 1, t.build.result(FMul, 1, eta, dot), root);
    const uint16_t through = t.build.result(FSub, size, t.build.result(Scale, size, i, eta),
                                            t.build.result(Scale, size, n, along));
    const uint16_t none = t.build.allocate(size); // zero: nothing writes it
    const uint16_t reflected = t.build.result(FOrdLess, 1, k, t.number(0.0f));
    t.define(at, t.build.result(SelectAll, size, reflected, none, through));
}

/// N where Nref . I < 0, else -N
void faceForward(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.resultSize(at, kReal);
    const uint16_t n = t.operand(at, 2, kReal, size), i = t.operand(at, 3, kReal, size),
                   reference = t.operand(at, 4, kReal, size);
    const uint16_t dot = t.build.result(Dot, size, reference, i, 0, 1);
    const uint16_t against = t.build.result(FOrdLess, 1, dot, t.number(0.0f));
    t.define(at, t.build.result(SelectAll, size, against, n, t.build.result(FNegate, size, n)));
}

bool geometric(Meaning& t, const SpirvInstruction& at) {
    const auto vector = [&](size_t operand) -> const Value& {
        const Value& v = t.operand(at, operand);
        if (!t.isKind(v.type, kReal) || t.size(v) > 4)
            refuseDamaged("an operand has a wrong type");
        return v;
    };
    switch (at.operand(1)) {
    case GLSLstd450Length: {
        const Value& x = vector(2);
        if (t.resultSize(at, kReal) != 1)
            refuseDamaged("a result has a wrong type");
        t.define(at, lengthOf(t, x.first, t.size(x)));
        return true;
    }
    case GLSLstd450Distance: {
        const Value& x = vector(2);
        if (t.resultSize(at, kReal) != 1)
            refuseDamaged("a result has a wrong type");
        const uint32_t size = t.size(x);
        t.define(at, lengthOf(t, t.build.result(FSub, size, x.first, t.operand(at, 3, kReal, size)), size));
        return true;
    }
    case GLSLstd450Normalize: {
        const uint32_t size = t.resultSize(at, kReal);
        const uint16_t x = t.operand(at, 2, kReal, size);
        const uint16_t inverse = t.build.result(FDiv, 1, t.number(1.0f), lengthOf(t, x, size));
        t.define(at, t.build.result(Scale, size, x, inverse));
        return true;
    }
    case GLSLstd450Cross:
        cross(t, at);
        return true;
    case GLSLstd450Reflect:
        reflect(t, at);
        return true;
    case GLSLstd450Refract:
        refract(t, at);
        return true;
    case GLSLstd450FaceForward:
        faceForward(t, at);
        return true;
    case GLSLstd450Determinant: {
        const Matrix m = squareOf(t, at);
        if (t.resultSize(at, kReal) != 1)
            refuseDamaged("a result has a wrong type");
        const unsigned all = (1u << m.rows) - 1u;
        t.define(at, minorOf(t, m, all, all));
        return true;
    }
    case GLSLstd450MatrixInverse:
        inverse(t, at);
        return true;
    default:
        return false;
    }
}

} // namespace

bool translateMatrix(Meaning& t, const SpirvInstruction& at) {
    switch (at.code) {
    case spv::OpExtInst:
        return geometric(t, at);
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar: {
        const uint32_t size = t.resultSize(at, kReal);
        t.define(at, t.build.result(Scale, size, t.operand(at, 0, kReal, size), t.operand(at, 1, kReal, 1)));
        return true;
    }
    case spv::OpMatrixTimesVector:
    case spv::OpVectorTimesMatrix:
        matrixWithVector(t, at);
        return true;
    case spv::OpMatrixTimesMatrix:
        multiplyMatrices(t, at);
        return true;
    case spv::OpOuterProduct:
        outerProduct(t, at);
        return true;
    case spv::OpTranspose: {
        const Matrix m = matrixOf(t, at, 0), shape = matrixOf(t, at.type, 0);
        if (shape.columns != m.rows || shape.rows != m.columns)
            refuseDamaged("a result has a wrong type");
        t.define(at, transposed(t, m).first);
        return true;
    }
    case spv::OpDot: {
        const Value& a = t.operand(at, 0);
        if (!t.isKind(a.type, kReal) || t.resultSize(at, kReal) != 1)
            refuseDamaged("an operand has a wrong type");
        const uint32_t size = t.size(a);
        t.define(at, t.build.result(Dot, size, a.first, t.operand(at, 1, kReal, size), 0, 1));
        return true;
    }
    default:
        return false;
    }
}

} // namespace touchstone::program
