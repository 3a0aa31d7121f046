/* A number that counts what is done with it, to compile exported C with as C++: `double` is one. */
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

static unsigned long long operations[4]; /* products, sums, quotients, calls */

struct counted {
    double v;
    counted() = default;
    template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
    constexpr counted(T x) : v(static_cast<double>(x)) {}
    template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
    explicit operator T() const { return static_cast<T>(v); }
};

#define OPERATOR(op, kind)                                        \
    static inline counted operator op(counted a, counted b)       \
    {                                                             \
        operations[kind]++;                                       \
        return counted(a.v op b.v);                               \
    }                                                             \
    static inline counted &operator op##=(counted &a, counted b)  \
    {                                                             \
        return a = a op b;                                        \
    }
OPERATOR(*, 0)
OPERATOR(+, 1)
OPERATOR(-, 1)
OPERATOR(/, 2)

static inline counted operator-(counted a) { return counted(-a.v); }

#define COMPARISON(op) \
    static inline bool operator op(counted a, counted b) { return a.v op b.v; }
COMPARISON(<)
COMPARISON(>)
COMPARISON(<=)
COMPARISON(>=)
COMPARISON(==)
COMPARISON(!=)

static inline bool isfinite(counted a) { return std::isfinite(a.v); }

#define FREE_1(f) \
    static inline counted f(counted a) { return counted(std::f(a.v)); }
#define FREE_2(f) \
    static inline counted f(counted a, counted b) { return counted(std::f(a.v, b.v)); }
#define CALL_1(f)                       \
    static inline counted f(counted a)  \
    {                                   \
        operations[3]++;                \
        return counted(std::f(a.v));    \
    }
FREE_1(fabs)
FREE_2(fmax)
FREE_2(fmin)
FREE_2(copysign)
FREE_2(nextafter)
CALL_1(sqrt)
CALL_1(exp)
CALL_1(log)
CALL_1(sin)
CALL_1(cos)
CALL_1(tanh)
CALL_1(atan)
CALL_1(floor)
CALL_1(ceil)
static inline counted ldexp(counted a, int n) { return counted(std::ldexp(a.v, n)); }
static inline counted pow(counted a, counted b)
{
    operations[3]++;
    return counted(std::pow(a.v, b.v));
}

#define double counted
