#include "tests/support/polynomial.h"

#include <algorithm>
#include <utility>

namespace corridor::test {
namespace {

Polynomial monomial(Integer c, int power) {
  std::vector<Integer> coefficients(static_cast<std::size_t>(power) + 1);
  coefficients.back() = std::move(c);
  return Polynomial(std::move(coefficients));
}

/// Returns the polynomial that has every root of p once. @pre p is not zero.
Polynomial squareFree(const Polynomial& p) {
  if (p.degree() < 2) return p;
  return *quotient(p, greatestCommonDivisor(p, p.derivative()));
}

/// Counts roots by Sturm's theorem. For a < b, a square-free polynomial has as many roots in (a, b]
/// as its chain has changes of sign at a, minus those at b.
class SturmChain {
 public:
  explicit SturmChain(const Polynomial& squareFree) : chain_{squareFree} {
    for (Polynomial next = squareFree.derivative(); !next.isZero();) {
      chain_.push_back(next);
      next = Polynomial() - remainder(chain_[chain_.size() - 2], chain_.back());
    }
  }
  /// Returns the number of roots in (n, n + 1]/2^k.
  int count(const Integer& n, unsigned k) const { return changes(n, k) - changes(n + 1, k); }

 private:
  int changes(const Integer& n, unsigned k) const {
    int count = 0, last = 0;
    for (const Polynomial& p : chain_) {
      const int sign = p.signAt(n, k);
      count += sign * last < 0;
      if (sign != 0) last = sign;
    }
    return count;
  }

  std::vector<Polynomial> chain_;
};

void isolate(const SturmChain& chain, const Polynomial& p, const Integer& n, unsigned k,
             std::vector<Root>& roots) {
  const int count = chain.count(n, k);
  if (count == 1) roots.emplace_back(p, n, k);
  if (count < 2) return;
  isolate(chain, p, 2 * n, k + 1, roots);
  isolate(chain, p, 2 * n + 1, k + 1, roots);
}

}  // namespace

Polynomial::Polynomial(std::vector<Integer> coefficients) : c_(std::move(coefficients)) {
  while (!c_.empty() && c_.back() == 0) c_.pop_back();
}

Integer Polynomial::scaledValue(const Integer& n, unsigned k) const {
  Integer value = 0;
  unsigned shift = 0;
  for (auto c = c_.rbegin(); c != c_.rend(); ++c, shift += k) value = value * n + (*c << shift);
  return value;
}

int Polynomial::signAt(const Integer& n, unsigned k) const {
  return scaledValue(n, k).sign();
}

Polynomial Polynomial::derivative() const {
  std::vector<Integer> d;
  for (std::size_t i = 1; i < c_.size(); ++i) d.push_back(c_[i] * i);
  return Polynomial(std::move(d));
}

Polynomial Polynomial::primitive() const {
  Integer divisor = 0;
  for (const Integer& c : c_) divisor = gcd(divisor, c);
  Polynomial p = *this;
  if (divisor > 1)
    for (Integer& c : p.c_) c /= divisor;
  return p;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  std::vector<Integer> c = a.c_;
  c.resize(std::max(a.c_.size(), b.c_.size()));
  for (std::size_t i = 0; i < b.c_.size(); ++i) c[i] += b.c_[i];
  return Polynomial(std::move(c));
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  std::vector<Integer> c = a.c_;
  c.resize(std::max(a.c_.size(), b.c_.size()));
  for (std::size_t i = 0; i < b.c_.size(); ++i) c[i] -= b.c_[i];
  return Polynomial(std::move(c));
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.isZero() || b.isZero()) return {};
  std::vector<Integer> c(a.c_.size() + b.c_.size() - 1);
  for (std::size_t i = 0; i < a.c_.size(); ++i)
    for (std::size_t j = 0; j < b.c_.size(); ++j) c[i + j] += a.c_[i] * b.c_[j];
  return Polynomial(std::move(c));
}

Polynomial remainder(const Polynomial& a, const Polynomial& b) {
  const Integer& lead = b.coefficients().back();
  const Polynomial scale = monomial(abs(lead), 0);
  Polynomial r = a;
  while (r.degree() >= b.degree()) {
    const Integer& top = r.coefficients().back();
    r = scale * r - monomial(lead < 0 ? Integer(-top) : top, r.degree() - b.degree()) * b;
  }
  return r.primitive();
}

// By Gauss's lemma, if b is primitive and divides a, the quotient has integer coefficients. So if
// an integer division leaves a remainder, a is not a multiple of b.
std::optional<Polynomial> quotient(Polynomial a, const Polynomial& b) {
  const Integer& lead = b.coefficients().back();
  Polynomial q;
  while (a.degree() >= b.degree()) {
    const Integer& top = a.coefficients().back();
    if (top % lead != 0) return std::nullopt;
    const Polynomial step = monomial(top / lead, a.degree() - b.degree());
    a = a - step * b;
    q = q + step;
  }
  if (!a.isZero()) return std::nullopt;
  return q;
}

Polynomial greatestCommonDivisor(Polynomial a, Polynomial b) {
  while (!b.isZero()) a = std::exchange(b, remainder(a, b));
  return a.primitive();
}

void Root::halve() {
  n_ *= 2;
  ++k_;
  // In units of 2^-k, the root is in (n, n + 1] or in (n + 1, n + 2]. There p changes its sign at
  // the root and nowhere else. If the root is n + 2, p is 0 there; n itself may be another root.
  const int middle = p_.signAt(n_ + 1, k_), end = p_.signAt(n_ + 2, k_);
  if (end == 0 || middle * end < 0) ++n_;
}

void Root::narrow(unsigned k) {
  while (k_ < k) halve();
}

int Root::signOf(const Polynomial& g) {
  const Polynomial r = remainder(g, p_);  // equal at the root, up to a positive factor
  if (r.degree() < 1) return r.signAt(0, 0);
  const Polynomial common = greatestCommonDivisor(p_, r);
  if (common.degree() > 0 && SturmChain(common).count(n_, k_) > 0) return 0;
  const SturmChain chain(squareFree(r));
  while (chain.count(n_, k_) > 0) halve();
  return r.signAt(n_ + 1, k_);
}

std::vector<Root> rootsInUnitInterval(const Polynomial& p) {
  const Polynomial simple = squareFree(p);
  std::vector<Root> roots;
  isolate(SturmChain(simple), simple, 0, 0, roots);
  return roots;
}

}  // namespace corridor::test
