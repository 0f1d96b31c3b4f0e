// Included before everything else in the work copy of tests/mutation: whether a mutant is the active one,
// and the operators that a mutant swaps. `a < SwapOp<17, ...> < b` keeps the operands that `a < b` had,
// whatever they are.
#pragma once

#ifdef __cplusplus

extern int astrosplat_mutant_active;              // id of the one mutant switched on; -1: none
extern unsigned char* astrosplat_mutant_reached;  // one byte per id, set when its place is executed

inline bool astrosplat_mutant(int id) {
    if (__builtin_expect(!astrosplat_mutant_reached[id], 0)) astrosplat_mutant_reached[id] = 1;
    return astrosplat_mutant_active == id;
}
#define ASTROSPLAT_MUTANT(id) (::astrosplat_mutant(id))

namespace astrosplat_mutation {

#define ASTROSPLAT_SWAP(Name, original, mutated)                                                     \
    template <int id>                                                                                \
    struct Name {};                                                                                  \
    template <int id, class A>                                                                       \
    struct Name##Left {                                                                              \
        const A& a;                                                                                  \
    };                                                                                               \
    template <int id, class A>                                                                       \
    inline Name##Left<id, A> operator original(const A& a, Name<id>) {                               \
        return {a};                                                                                  \
    }                                                                                                \
    template <int id, class A, class B>                                                              \
    inline auto operator original(Name##Left<id, A> left, const B& b)->decltype(left.a original b) { \
        if (ASTROSPLAT_MUTANT(id)) return left.a mutated b;                                          \
        return left.a original b;                                                                    \
    }
ASTROSPLAT_SWAP(Less, <, <=)
ASTROSPLAT_SWAP(LessEqual, <=, <)
ASTROSPLAT_SWAP(Greater, >, >=)
ASTROSPLAT_SWAP(GreaterEqual, >=, >)
ASTROSPLAT_SWAP(Equal, ==, !=)
ASTROSPLAT_SWAP(NotEqual, !=, ==)
ASTROSPLAT_SWAP(Plus, +, -)
ASTROSPLAT_SWAP(Minus, -, +)
ASTROSPLAT_SWAP(Times, *, /)
ASTROSPLAT_SWAP(Divided, /, *)
#undef ASTROSPLAT_SWAP

}  // namespace astrosplat_mutation

#endif
