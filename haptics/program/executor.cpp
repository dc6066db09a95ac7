#include "haptics/program/executor.h"

#include "haptics/program/integer_functions.h"
#include "haptics/program/real_functions.h"
#include "haptics/program/registers.h"

#include <cmath>

namespace touchstone::program {

namespace {

/// What the elementwise operations do with one instruction.
template <class Registers>
struct Executed {
    using Real = typename Registers::Real;
    Registers& r;
    const Instruction& at;

    template <class Function>
    void real1(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.set(at.to + i, function(r.real(at.a + i)));
    }
    template <class Function>
    void real2(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.set(at.to + i, function(r.real(at.a + i), r.real(at.b + i)));
    }
    template <class Function>
    void real3(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.set(at.to + i, function(r.real(at.a + i), r.real(at.b + i), r.real(at.c + i)));
    }
    /// A function that is constant between jumps.
    template <class Function>
    void steps(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.setBits(at.to + i, std::bit_cast<uint32_t>(static_cast<float>(function(number(at.a + i)))));
    }
    template <class Function>
    void bits1(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.setBits(at.to + i, static_cast<uint32_t>(function(r.bits(at.a + i))));
    }
    template <class Function>
    void bits2(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.setBits(at.to + i, static_cast<uint32_t>(function(r.bits(at.a + i), r.bits(at.b + i))));
    }
    template <class Function>
    void compare(const Function& function) {
        for (size_t i = 0; i < at.count; ++i)
            r.setBits(at.to + i, function(number(at.a + i), number(at.b + i)) ? 1 : 0);
    }
    template <class Function>
    [[nodiscard]] bool divide(const Function& function) {
        for (size_t i = 0; i < at.count; ++i) {
            const uint32_t divisor = r.bits(at.b + i);
            if (divisor == 0)
                return false;
            r.setBits(at.to + i, static_cast<uint32_t>(function(r.bits(at.a + i), divisor)));
        }
        return true;
    }
    [[nodiscard]] float number(size_t i) const { return std::bit_cast<float>(r.bits(i)); }
    void dot() {
        Real sum = multiply(r.real(at.a), r.real(at.b));
        for (size_t i = 1; i < at.count; ++i)
            sum = add(sum, multiply(r.real(at.a + i), r.real(at.b + i)));
        r.set(at.to, sum);
    }
    void select(bool each) {
        for (size_t i = 0; i < at.count; ++i)
            r.move(at.to + i, (r.bits(each ? at.a + i : at.a) != 0 ? at.b : at.c) + i);
    }
    [[nodiscard]] uint32_t trueCount() const {
        uint32_t count = 0;
        for (size_t i = 0; i < at.count; ++i)
            count += r.bits(at.a + i) != 0 ? 1 : 0;
        return count;
    }
};

/// Everything besides control flow.
template <class Registers>
[[gnu::always_inline]] inline Ending perform(Registers& r, const Instruction& at) {
    using R = typename Registers::Real;
    Executed<Registers> step{r, at};
    const auto divided = [](bool done) { return done ? Ending::Finished : Ending::DivisionByZero; };
    switch (at.operation) {
        using enum Operation;
    case Move:
        for (size_t i = 0; i < at.count; ++i)
            r.move(at.to + i, at.a + i);
        break;
#define TOUCHSTONE_CASE(name, what)                                                                          \
    case name:                                                                                               \
        step.what;                                                                                           \
        break;
        TOUCHSTONE_CASE(FAdd, real2([](const R& x, const R& y) { return add(x, y); }))
        TOUCHSTONE_CASE(FSub, real2([](const R& x, const R& y) { return subtract(x, y); }))
        TOUCHSTONE_CASE(FMul, real2([](const R& x, const R& y) { return multiply(x, y); }))
        TOUCHSTONE_CASE(FDiv, real2([](const R& x, const R& y) { return program::divide(x, y); }))
        TOUCHSTONE_CASE(FNegate, real1([](const R& x) { return negate(x); }))
        TOUCHSTONE_CASE(FRem, real2([](const R& x, const R& y) { return program::remainder(x, y); }))
        TOUCHSTONE_CASE(FMod, real2([](const R& x, const R& y) { return modFloor(x, y); }))
        TOUCHSTONE_CASE(Scale, real1([&, s = r.real(at.b)](const R& x) { return multiply(x, s); }))
        TOUCHSTONE_CASE(Dot, dot())
        TOUCHSTONE_CASE(FAbs, real1([](const R& x) { return absolute(x); }))
        TOUCHSTONE_CASE(FSign, steps(signOf))
        TOUCHSTONE_CASE(Floor, steps([](float x) { return std::floor(x); }))
        TOUCHSTONE_CASE(Ceil, steps([](float x) { return std::ceil(x); }))
        TOUCHSTONE_CASE(Fract, real1([](const R& x) { return fraction(x); }))
        TOUCHSTONE_CASE(Trunc, steps([](float x) { return std::trunc(x); }))
        TOUCHSTONE_CASE(Round, steps([](float x) { return std::round(x); }))
        TOUCHSTONE_CASE(RoundEven, steps([](float x) { return std::nearbyint(x); }))
        TOUCHSTONE_CASE(Sin, real1([](const R& x) { return sine(x); }))
        TOUCHSTONE_CASE(Cos, real1([](const R& x) { return cosine(x); }))
        TOUCHSTONE_CASE(Tan, real1([](const R& x) { return tangent(x); }))
        TOUCHSTONE_CASE(Asin, real1([](const R& x) { return arcSine(x); }))
        TOUCHSTONE_CASE(Acos, real1([](const R& x) { return arcCosine(x); }))
        TOUCHSTONE_CASE(Atan, real1([](const R& x) { return arcTangent(x); }))
        TOUCHSTONE_CASE(Sinh, real1([](const R& x) { return hyperbolicSine(x); }))
        TOUCHSTONE_CASE(Cosh, real1([](const R& x) { return hyperbolicCosine(x); }))
        TOUCHSTONE_CASE(Tanh, real1([](const R& x) { return hyperbolicTangent(x); }))
        TOUCHSTONE_CASE(Asinh, real1([](const R& x) { return areaSine(x); }))
        TOUCHSTONE_CASE(Acosh, real1([](const R& x) { return areaCosine(x); }))
        TOUCHSTONE_CASE(Atanh, real1([](const R& x) { return areaTangent(x); }))
        TOUCHSTONE_CASE(Atan2, real2([](const R& y, const R& x) { return arcTangent(y, x); }))
        TOUCHSTONE_CASE(Pow, real2([](const R& x, const R& y) { return power(x, y); }))
        TOUCHSTONE_CASE(Exp, real1([](const R& x) { return exponential(x); }))
        TOUCHSTONE_CASE(Log, real1([](const R& x) { return logarithm(x); }))
        TOUCHSTONE_CASE(Exp2, real1([](const R& x) { return powerOfTwo(x); }))
        TOUCHSTONE_CASE(Log2, real1([](const R& x) { return binaryLogarithm(x); }))
        TOUCHSTONE_CASE(Sqrt, real1([](const R& x) { return squareRoot(x); }))
        TOUCHSTONE_CASE(InverseSqrt, real1([](const R& x) { return inverseSquareRoot(x); }))
        TOUCHSTONE_CASE(FMin, real2([](const R& x, const R& y) { return minimum(x, y); }))
        TOUCHSTONE_CASE(FMax, real2([](const R& x, const R& y) { return maximum(x, y); }))
        TOUCHSTONE_CASE(FClamp, real3([](const R& x, const R& l, const R& h) { return clamp(x, l, h); }))
        TOUCHSTONE_CASE(FMix, real3([](const R& x, const R& y, const R& a) { return mix(x, y, a); }))
        TOUCHSTONE_CASE(SmoothStep,
                        real3([](const R& l, const R& h, const R& x) { return smoothStep(l, h, x); }))
        TOUCHSTONE_CASE(Fma,
                        real3([](const R& x, const R& y, const R& z) { return fusedMultiplyAdd(x, y, z); }))
        TOUCHSTONE_CASE(FrexpSignificand, real1([](const R& x) { return significand(x); }))
    case Operation::Step:
        for (size_t i = 0; i < at.count; ++i)
            r.set(at.to + i, constant<R>(step.number(at.b + i) < step.number(at.a + i) ? 0.0f : 1.0f));
        break;
    case Ldexp:
        for (size_t i = 0; i < at.count; ++i)
            r.set(at.to + i, scaleByPower(r.real(at.a + i), asSigned(r.bits(at.b + i))));
        break;
    case FrexpExponent:
        for (size_t i = 0; i < at.count; ++i) {
            int exponent = 0;
            const float x = step.number(at.a + i);
            (void)std::frexp(x, &exponent);
            r.setBits(at.to + i, std::isfinite(x) ? asBits(exponent) : 0);
        }
        break;
        TOUCHSTONE_CASE(FOrdEqual, compare([](float x, float y) { return x == y; }))
        TOUCHSTONE_CASE(FOrdNotEqual, compare([](float x, float y) { return x < y || x > y; }))
        TOUCHSTONE_CASE(FOrdLess, compare([](float x, float y) { return x < y; }))
        TOUCHSTONE_CASE(FOrdLessEqual, compare([](float x, float y) { return x <= y; }))
        TOUCHSTONE_CASE(FUnordEqual, compare([](float x, float y) { return !(x < y || x > y); }))
        TOUCHSTONE_CASE(FUnordNotEqual, compare([](float x, float y) { return x != y; }))
        TOUCHSTONE_CASE(FUnordLess, compare([](float x, float y) { return !(x >= y); }))
        TOUCHSTONE_CASE(FUnordLessEqual, compare([](float x, float y) { return !(x > y); }))
        TOUCHSTONE_CASE(IsNan, bits1([](uint32_t x) { return std::isnan(std::bit_cast<float>(x)); }))
        TOUCHSTONE_CASE(IsInf, bits1([](uint32_t x) { return std::isinf(std::bit_cast<float>(x)); }))
        TOUCHSTONE_CASE(FToS, bits1([](uint32_t x) { return asBits(toSigned(std::bit_cast<float>(x))); }))
        TOUCHSTONE_CASE(FToU, bits1([](uint32_t x) { return toUnsigned(std::bit_cast<float>(x)); }))
        TOUCHSTONE_CASE(
            SToF, bits1([](uint32_t x) { return std::bit_cast<uint32_t>(static_cast<float>(asSigned(x))); }))
        TOUCHSTONE_CASE(UToF,
                        bits1([](uint32_t x) { return std::bit_cast<uint32_t>(static_cast<float>(x)); }))
        TOUCHSTONE_CASE(IAdd, bits2([](uint32_t x, uint32_t y) { return x + y; }))
        TOUCHSTONE_CASE(ISub, bits2([](uint32_t x, uint32_t y) { return x - y; }))
        TOUCHSTONE_CASE(IMul, bits2([](uint32_t x, uint32_t y) { return x * y; }))
        TOUCHSTONE_CASE(INegate, bits1([](uint32_t x) { return 0u - x; }))
    case UDiv:
        return divided(step.divide([](uint32_t x, uint32_t y) { return x / y; }));
    case SDiv:
        return divided(step.divide(divideSigned));
    case UMod:
        return divided(step.divide([](uint32_t x, uint32_t y) { return x % y; }));
    case SRem:
        return divided(step.divide(remainderSigned));
    case SMod:
        return divided(step.divide(moduloSigned));
        TOUCHSTONE_CASE(ShiftLeft, bits2([](uint32_t x, uint32_t y) { return x << (y & 31u); }))
        TOUCHSTONE_CASE(ShiftRight, bits2([](uint32_t x, uint32_t y) { return x >> (y & 31u); }))
        TOUCHSTONE_CASE(ShiftRightSigned,
                        bits2([](uint32_t x, uint32_t y) { return asBits(asSigned(x) >> (y & 31u)); }))
        TOUCHSTONE_CASE(And, bits2([](uint32_t x, uint32_t y) { return x & y; }))
        TOUCHSTONE_CASE(Or, bits2([](uint32_t x, uint32_t y) { return x | y; }))
        TOUCHSTONE_CASE(Xor, bits2([](uint32_t x, uint32_t y) { return x ^ y; }))
        TOUCHSTONE_CASE(Not, bits1([](uint32_t x) { return ~x; }))
        TOUCHSTONE_CASE(BitReverse, bits1(reverseBits))
        TOUCHSTONE_CASE(BitCount, bits1([](uint32_t x) { return std::popcount(x); }))
        TOUCHSTONE_CASE(BitUExtract, bits1([offset = r.bits(at.b), bits = r.bits(at.c)](uint32_t x) {
                            return extractUnsigned(x, offset, bits);
                        }))
        TOUCHSTONE_CASE(BitSExtract, bits1([offset = r.bits(at.b), bits = r.bits(at.c)](uint32_t x) {
                            return extractSigned(x, offset, bits);
                        }))
        TOUCHSTONE_CASE(BitInsert,
                        bits2([offset = r.bits(at.c), bits = r.bits(at.c + 1u)](uint32_t x, uint32_t y) {
                            return insertBits(x, y, offset, bits);
                        }))
        TOUCHSTONE_CASE(FindILsb, bits1(lowestBit))
        TOUCHSTONE_CASE(FindSMsb, bits1(highestBitSigned))
        TOUCHSTONE_CASE(FindUMsb, bits1(highestBit))
        TOUCHSTONE_CASE(SAbs, bits1([](uint32_t x) { return asSigned(x) < 0 ? 0u - x : x; }))
        TOUCHSTONE_CASE(SSign, bits1([](uint32_t x) {
                            return asBits((asSigned(x) > 0 ? 1 : 0) - (asSigned(x) < 0 ? 1 : 0));
                        }))
        TOUCHSTONE_CASE(SMin, bits2([](uint32_t x, uint32_t y) { return asSigned(y) < asSigned(x) ? y : x; }))
        TOUCHSTONE_CASE(SMax, bits2([](uint32_t x, uint32_t y) { return asSigned(x) < asSigned(y) ? y : x; }))
        TOUCHSTONE_CASE(UMin, bits2([](uint32_t x, uint32_t y) { return std::min(x, y); }))
        TOUCHSTONE_CASE(UMax, bits2([](uint32_t x, uint32_t y) { return std::max(x, y); }))
        TOUCHSTONE_CASE(UMulHigh, bits2(highProduct))
        TOUCHSTONE_CASE(SMulHigh, bits2(highProductSigned))
        TOUCHSTONE_CASE(Carry, bits2([](uint32_t x, uint32_t y) { return x + y < x; }))
        TOUCHSTONE_CASE(Borrow, bits2([](uint32_t x, uint32_t y) { return x < y; }))
        TOUCHSTONE_CASE(IEqual, bits2([](uint32_t x, uint32_t y) { return x == y; }))
        TOUCHSTONE_CASE(INotEqual, bits2([](uint32_t x, uint32_t y) { return x != y; }))
        TOUCHSTONE_CASE(SLess, bits2([](uint32_t x, uint32_t y) { return asSigned(x) < asSigned(y); }))
        TOUCHSTONE_CASE(SLessEqual, bits2([](uint32_t x, uint32_t y) { return asSigned(x) <= asSigned(y); }))
        TOUCHSTONE_CASE(ULess, bits2([](uint32_t x, uint32_t y) { return x < y; }))
        TOUCHSTONE_CASE(ULessEqual, bits2([](uint32_t x, uint32_t y) { return x <= y; }))
        TOUCHSTONE_CASE(LogicalNot, bits1([](uint32_t x) { return x == 0; }))
    case Any:
        r.setBits(at.to, step.trueCount() > 0);
        break;
    case All:
        r.setBits(at.to, step.trueCount() == at.count);
        break;
        TOUCHSTONE_CASE(Select, select(true))
        TOUCHSTONE_CASE(SelectAll, select(false))
#undef TOUCHSTONE_CASE
    case Index:
        if (r.bits(at.a) >= at.c) // a negative index is a large number
            return Ending::BadIndex;
        r.setBits(at.to, r.bits(at.a) * at.b);
        break;
    case LoadAt:
        for (size_t i = 0; i < at.count; ++i)
            r.move(at.to + i, at.a + r.bits(at.b) + i);
        break;
    case StoreAt:
        for (size_t i = 0; i < at.count; ++i)
            r.move(at.to + r.bits(at.b) + i, at.a + i);
        break;
    case Jump:
    case JumpUnless:
    case JumpIfEqual:
    case Return:
    case Unreachable:
        break;
    }
    return Ending::Finished;
}

/// Instructions between two jumps backwards run forwards, so that the cost of each of them counts at most
/// once: the difference of the running sums bounds what they took.
template <class Registers>
RunResult execute(const RegisterProgram& program, Registers& r, uint32_t budget) {
    const Instruction* const first = program.instructions.data();
    size_t from = 0; // of the part of the program that runs since the last jump backwards
    uint32_t spent = 0;
    for (size_t i = 0;; ++i) {
        const Instruction& at = first[i];
        bool jumps = false;
        switch (at.operation) {
        case Operation::Jump:
            jumps = true;
            break;
        case Operation::JumpUnless:
            jumps = r.bits(at.a) == 0;
            break;
        case Operation::JumpIfEqual:
            jumps = r.bits(at.a) == r.bits(at.b);
            break;
        case Operation::Return:
        case Operation::Unreachable:
            return {at.operation == Operation::Return ? Ending::Finished : Ending::Unreachable,
                    spent + program.cost[i + 1] - program.cost[from], static_cast<uint16_t>(i)};
        default:
            if (const Ending ending = perform(r, at); ending != Ending::Finished)
                return {ending, spent + program.cost[i + 1] - program.cost[from], static_cast<uint16_t>(i)};
            break;
        }
        if (!jumps)
            continue;
        if (at.c <= i) {
            spent += program.cost[i + 1] - program.cost[from];
            from = at.c;
            if (spent > budget)
                return {Ending::BudgetReached, spent, static_cast<uint16_t>(i)};
        }
        i = size_t{at.c} - 1; // wraps round at 0, and the loop adds 1
    }
}

/// An output that the program never writes stays a NaN: a loop without an end and without an effect is none
/// that a compiler keeps, and what follows it goes with it.
template <class Registers>
void spoilOutputs(const RegisterProgram& program, Registers& r) {
    for (const Port& port : program.outputs)
        for (size_t i = 0; i < port.count; ++i)
            r.set(port.first + i, constant<typename Registers::Real>(NAN));
}

} // namespace

RunResult run(const RegisterProgram& program, std::span<const PortValue, kMaxLocations> inputs,
              std::span<PortValue, kMaxLocations> outputs, uint32_t budget) noexcept {
    PlainRegisters r(program);
    for (const Port& port : program.inputs)
        for (size_t i = 0; i < port.count; ++i)
            r.set(port.first + i, inputs[port.location][i]);
    spoilOutputs(program, r);
    RunResult result = execute(program, r, budget);
    for (const Port& port : program.outputs)
        for (size_t i = 0; i < port.count; ++i) {
            const float value = r.real(port.first + i);
            outputs[port.location][i] = value;
            if (!std::isfinite(value) && result.ending == Ending::Finished)
                result = {Ending::NotFinite, result.cost, static_cast<uint16_t>(port.first + i)};
        }
    return result;
}

RunResult runDual(const RegisterProgram& program, std::span<const DualPortValue, kMaxLocations> inputs,
                  std::span<DualPortValue, kMaxLocations> outputs, uint32_t budget) noexcept {
    DualRegisters r(program);
    for (const Port& port : program.inputs)
        for (size_t i = 0; i < port.count; ++i)
            r.set(port.first + i, {inputs[port.location].v[i], inputs[port.location].d[i]});
    spoilOutputs(program, r);
    RunResult result = execute(program, r, budget);
    for (const Port& port : program.outputs)
        for (size_t i = 0; i < port.count; ++i) {
            const Dual value = r.real(port.first + i);
            outputs[port.location].v[i] = value.v;
            outputs[port.location].d[i] = value.d;
            if (!std::isfinite(value.v + value.d[0] + value.d[1] + value.d[2]) &&
                result.ending == Ending::Finished)
                result = {Ending::NotFinite, result.cost, static_cast<uint16_t>(port.first + i)};
        }
    return result;
}

} // namespace touchstone::program
