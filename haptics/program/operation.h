#pragma once
// The operations of register programs: one table.

#include <cstdint>

namespace touchstone::program {

/// X(name, cost): cost in units of a float addition per component, for the instruction budget. Unless stated
/// otherwise an operation takes and writes `count` components: to[i] = op(a[i], b[i], c[i]).
#define TOUCHSTONE_PROGRAM_OPERATIONS(X)                                                                     \
    X(Move, 1)                                                                                               \
    X(FAdd, 1)                                                                                               \
    X(FSub, 1)                                                                                               \
    X(FMul, 1)                                                                                               \
    X(FDiv, 2)                                                                                               \
    X(FNegate, 1)                                                                                            \
    X(FRem, 8)                                                                                               \
    X(FMod, 4)                                                                                               \
    X(Scale, 1) /* b is one component */                                                                     \
    X(Dot, 1)   /* `to` is one component */                                                                  \
    X(FAbs, 1)                                                                                               \
    X(FSign, 1)                                                                                              \
    X(Floor, 1)                                                                                              \
    X(Ceil, 1)                                                                                               \
    X(Fract, 1)                                                                                              \
    X(Trunc, 1)                                                                                              \
    X(Round, 2)                                                                                              \
    X(RoundEven, 2)                                                                                          \
    X(Sin, 8)                                                                                                \
    X(Cos, 8)                                                                                                \
    X(Tan, 12)                                                                                               \
    X(Asin, 12)                                                                                              \
    X(Acos, 12)                                                                                              \
    X(Atan, 12)                                                                                              \
    X(Sinh, 12)                                                                                              \
    X(Cosh, 12)                                                                                              \
    X(Tanh, 12)                                                                                              \
    X(Asinh, 12)                                                                                             \
    X(Acosh, 12)                                                                                             \
    X(Atanh, 12)                                                                                             \
    X(Atan2, 16)                                                                                             \
    X(Pow, 16)                                                                                               \
    X(Exp, 8)                                                                                                \
    X(Log, 8)                                                                                                \
    X(Exp2, 8)                                                                                               \
    X(Log2, 8)                                                                                               \
    X(Sqrt, 4)                                                                                               \
    X(InverseSqrt, 4)                                                                                        \
    X(FMin, 1)                                                                                               \
    X(FMax, 1)                                                                                               \
    X(FClamp, 2)                                                                                             \
    X(FMix, 2)                                                                                               \
    X(Step, 1)                                                                                               \
    X(SmoothStep, 4)                                                                                         \
    X(Fma, 2)                                                                                                \
    X(Ldexp, 4) /* b: integers */                                                                            \
    X(FrexpSignificand, 4)                                                                                   \
    X(FrexpExponent, 4) /* integers */                                                                       \
    X(FOrdEqual, 1)                                                                                          \
    X(FOrdNotEqual, 1)                                                                                       \
    X(FOrdLess, 1)                                                                                           \
    X(FOrdLessEqual, 1)                                                                                      \
    X(FUnordEqual, 1)                                                                                        \
    X(FUnordNotEqual, 1)                                                                                     \
    X(FUnordLess, 1)                                                                                         \
    X(FUnordLessEqual, 1)                                                                                    \
    X(IsNan, 1)                                                                                              \
    X(IsInf, 1)                                                                                              \
    X(FToS, 1) /* saturates; of a NaN: 0 */                                                                  \
    X(FToU, 1)                                                                                               \
    X(SToF, 1)                                                                                               \
    X(UToF, 1)                                                                                               \
    X(IAdd, 1)                                                                                               \
    X(ISub, 1)                                                                                               \
    X(IMul, 1)                                                                                               \
    X(INegate, 1)                                                                                            \
    X(UDiv, 4) /* by zero: the run ends, as for the next four */                                             \
    X(SDiv, 4)                                                                                               \
    X(UMod, 4)                                                                                               \
    X(SRem, 4)                                                                                               \
    X(SMod, 4)                                                                                               \
    X(ShiftLeft, 1) /* by the amount modulo 32 */                                                            \
    X(ShiftRight, 1)                                                                                         \
    X(ShiftRightSigned, 1)                                                                                   \
    X(And, 1)                                                                                                \
    X(Or, 1)                                                                                                 \
    X(Xor, 1)                                                                                                \
    X(Not, 1)                                                                                                \
    X(BitReverse, 4)                                                                                         \
    X(BitCount, 1)                                                                                           \
    X(BitUExtract, 2) /* b, c: one component, as for the next */                                             \
    X(BitSExtract, 2)                                                                                        \
    X(BitInsert, 2) /* c: two components, offset and length */                                               \
    X(FindILsb, 1)                                                                                           \
    X(FindSMsb, 1)                                                                                           \
    X(FindUMsb, 1)                                                                                           \
    X(SAbs, 1)                                                                                               \
    X(SSign, 1)                                                                                              \
    X(SMin, 1)                                                                                               \
    X(SMax, 1)                                                                                               \
    X(UMin, 1)                                                                                               \
    X(UMax, 1)                                                                                               \
    X(UMulHigh, 1)                                                                                           \
    X(SMulHigh, 1)                                                                                           \
    X(Carry, 1)                                                                                              \
    X(Borrow, 1)                                                                                             \
    X(IEqual, 1)                                                                                             \
    X(INotEqual, 1)                                                                                          \
    X(SLess, 1)                                                                                              \
    X(SLessEqual, 1)                                                                                         \
    X(ULess, 1)                                                                                              \
    X(ULessEqual, 1)                                                                                         \
    X(LogicalNot, 1)                                                                                         \
    X(Any, 1) /* `to` is one component, as for the next */                                                   \
    X(All, 1)                                                                                                \
    X(Select, 1)      /* a[i] ? b[i] : c[i] */                                                               \
    X(SelectAll, 1)   /* a ? b[i] : c[i] */                                                                  \
    X(Index, 1)       /* to = a * b where the number a is below the number c; else the run ends */           \
    X(LoadAt, 1)      /* to[i] = slot a + r[b] + i */                                                        \
    X(StoreAt, 1)     /* slot to + r[b] + i = a[i] */                                                        \
    X(Jump, 1)        /* to instruction c, as the next two */                                                \
    X(JumpUnless, 1)  /* where a is false */                                                                 \
    X(JumpIfEqual, 1) /* where a and b are the same bits */                                                  \
    X(Return, 1)                                                                                             \
    X(Unreachable, 1)

enum class Operation : uint8_t {
#define TOUCHSTONE_OPERATION(name, cost) name,
    TOUCHSTONE_PROGRAM_OPERATIONS(TOUCHSTONE_OPERATION)
#undef TOUCHSTONE_OPERATION
};

} // namespace touchstone::program
