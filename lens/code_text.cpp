#include "lens/code_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <string_view>

#include "lens/code_generation.h"

namespace etendue {

namespace {

template <class T>
std::string shortest(T number) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    std::string result(text.data(), end);
    if (result.find_first_of(".en") == std::string::npos) result += ".0";
    return result;
}

/// A number as 1.5f, the float nearest to it, or Real(1.5).
std::string literalIn(CodeLanguage language, std::string_view text) {
    if (language == CodeLanguage::cPlusPlus) return "Real(" + std::string(text) + ")";
    double number = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return shortest(static_cast<float>(number)) + "f";
}

const std::map<std::string_view, std::string_view>& words(CodeLanguage language) {
    static const std::map<std::string_view, std::string_view> cPlusPlus{
        {"FUNCTION", "static"},
        {"REAL", "Real"},
        {"JET", "Jet"},
        {"VALUE", "value"},
        {"BYX", "byX"},
        {"BYY", "byY"},
        {"MAYBE_UNUSED", "[[maybe_unused]]"}};
    static const std::map<std::string_view, std::string_view> glsl{
        {"FUNCTION", ""}, {"REAL", "float"}, {"JET", "vec3"},     {"VALUE", "x"},
        {"BYX", "y"},     {"BYY", "z"},      {"MAYBE_UNUSED", ""}};
    return language == CodeLanguage::cPlusPlus ? cPlusPlus : glsl;
}

bool isInWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

/// The number that `text` begins with.
std::string_view numberAtFront(std::string_view text) {
    double ignored = 0.0;
    const char* end = std::from_chars(text.data(), text.data() + text.size(), ignored).ptr;
    return text.substr(0, static_cast<std::size_t>(end - text.data()));
}

std::string_view wordAtFront(std::string_view text) {
    return text.substr(
        0, static_cast<std::size_t>(std::ranges::find_if_not(text, isInWord) - text.begin()));
}

/// DoubleGaussRay for a struct, doubleGaussTrace for a function.
std::string glslName(std::string lens, std::string word) {
    if (std::isupper(static_cast<unsigned char>(word.front())))
        lens.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(lens.front())));
    word.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(word.front())));
    return lens + word;
}

}  // namespace

std::string literal(double number) { return shortest(number); }

std::string translate(const std::string& neutral, CodeLanguage language, const std::string& name) {
    std::string result;
    std::string_view rest = neutral;
    while (!rest.empty()) {
        std::string_view taken = rest.substr(0, 1);
        if (rest.starts_with("//")) {
            taken = rest.substr(0, rest.find('\n'));
            result += taken;
        } else if (rest.front() == '@') {
            taken = rest.substr(0, 1 + wordAtFront(rest.substr(1)).size());
            const std::string word(taken.substr(1));
            result += language == CodeLanguage::glsl ? glslName(name, word) : word;
        } else if (isDigit(rest.front())) {
            taken = numberAtFront(rest);
            const bool isReal = taken.find_first_of(".e") != std::string_view::npos;
            result += isReal ? literalIn(language, taken) : std::string(taken);
        } else if (isInWord(rest.front())) {
            taken = wordAtFront(rest);
            const auto known = words(language).find(taken);
            if (known == words(language).end())
                result += taken;
            else if (!known->second.empty())
                result += known->second;
            else
                taken = rest.substr(0, taken.size() + 1);  // and the space behind it
        } else {
            result += taken;
        }
        rest.remove_prefix(taken.size());
    }
    return result;
}

namespace {

/// An expression, and whether it is a jet.
struct Expression {
    std::string text;
    bool moves;
};

Expression operator*(const Expression& a, const Expression& b) {
    if (a.text.empty()) return b;
    if (b.text.empty()) return a;
    if (a.moves && b.moves) return {"@product(" + a.text + ", " + b.text + ")", true};
    // Numbers first: they multiply with each other before they meet a jet.
    return a.moves ? Expression{b.text + " * " + a.text, true}
                   : Expression{a.text + " * " + b.text, b.moves};
}

std::string typeOf(bool moves) { return moves ? "JET" : "REAL"; }

class PolynomialText {
public:
    PolynomialText(const SparsePolynomial& polynomial, Moving moving,
                   const std::vector<CodeOutput>& wanted)
        : polynomial_(polynomial),
          isAxial_(polynomial.basis == PolynomialBasis::axial),
          sMoves_(moving.s),
          pMoves_(moving.p || (moving.s && !polynomial.scaling.coupling.isZero())),
          wanted_(wanted) {}

    std::string text() {
        writeScaledInputs();
        writeVariables();
        writePowers();
        for (const TermGroup& group : polynomial_.groups) writeGroup(group);
        if (isAxial_) writeVectors();
        return text_;
    }

private:
    void line(const std::string& statement) { text_ += "    " + statement + "\n"; }
    void define(const std::string& name, bool moves, const std::string& value) {
        line(typeOf(moves) + " " + name + " = " + value + ";");
    }
    /// Of which a sparse polynomial may need none.
    void defineInput(const std::string& name, bool moves, const std::string& value) {
        line("MAYBE_UNUSED " + typeOf(moves) + " " + name + " = " + value + ";");
    }

    void writeScaledInputs() {
        const InputScaling& scaling = polynomial_.scaling;
        const std::string s = literal(scaling.sensorScale), p = literal(scaling.secondScale);
        for (const char* axis : {"x", "y"}) {
            const std::string i = axis;
            defineInput(i + "s", sMoves_, s + " * s" + i);
            const double coupling = scaling.coupling[axis[0] - 'x'];
            std::string decoupled = "p" + i;
            if (coupling != 0.0)
                decoupled = "(p" + i + " + " + literal(coupling) + " * s" + i + ")";
            defineInput(i + "p", pMoves_, p + " * " + decoupled);
        }
        defineInput("perMicrometre", false, "1000.0 / nm");
        defineInput("w", false,
                    literal(scaling.waveScale) + " * (perMicrometre * perMicrometre - " +
                        literal(scaling.waveOffset) + ")");
    }

    void writeVariables() {
        const Expression xs{"xs", sMoves_}, ys{"ys", sMoves_}, xp{"xp", pMoves_}, yp{"yp", pMoves_};
        if (!isAxial_) {
            variables_ = {{xs, ys, xp, yp, {"w", false}}};
            return;
        }
        const auto sum = [&](const char* name, const Expression& a, const Expression& b) {
            defineInput(name, a.moves, a.text + " + " + b.text);
            return Expression{name, a.moves};
        };
        variables_ = {{sum("rho", xs * xs, ys * ys),
                       sum("sigma", xp * xp, yp * yp),
                       sum("kappa", xs * xp, ys * yp),
                       {"w", false},
                       {"", false}}};
    }

    void writePowers() {
        Exponents highest{};
        for (const TermGroup& group : polynomial_.groups)
            for (const Exponents& e : group.terms)
                for (std::size_t v = 0; v < e.size(); ++v) highest[v] = std::max(highest[v], e[v]);
        for (std::size_t v = 0; v < highest.size(); ++v)
            for (int i = 2; i <= highest[v]; ++i) {
                const Expression next = power(v, i - 1) * power(v, 1);
                define(power(v, i).text, next.moves, next.text);
            }
    }

    Expression power(std::size_t variable, int exponent) const {
        const Expression& v = variables_[variable];
        if (exponent == 0) return {"", false};
        return {exponent == 1 ? v.text : v.text + std::to_string(exponent), v.moves};
    }

    /// Still factors first.
    Expression monomial(const Exponents& exponents) const {
        Expression still{"", false}, moving{"", true};
        for (std::size_t v = 0; v < exponents.size(); ++v) {
            const Expression factor = power(v, exponents[v]);
            Expression& part = factor.moves ? moving : still;
            part = part * factor;
        }
        if (still.text.empty() && moving.text.empty()) still.text = "1.0";
        return still * moving;
    }

    bool isVector(int output) const { return output < 2 * polynomial_.outputs.vectors; }

    /// The sum of an output's coefficients: the output itself, or, of an axial vector, b for one
    /// component and c for the other. Nothing for an output that nobody wants.
    Expression sumOf(int output) const {
        const bool moves = isVector(output) && (sMoves_ || pMoves_);
        for (const CodeOutput& wanted : wanted_) {
            if (isAxial_ && isVector(output) && wanted.index / 2 == output / 2)
                return {(output % 2 == 0 ? "b" : "c") + std::to_string(output / 2), moves};
            if (wanted.index == output) return {wanted.name, moves};
        }
        return {"", false};
    }

    void writeGroup(const TermGroup& group) {
        std::vector<std::pair<Expression, Eigen::Index>> sums;  // and their coefficients' row
        for (std::size_t i = 0; i < group.outputs.size(); ++i) {
            const Expression sum = sumOf(group.outputs[i]);
            if (!sum.text.empty()) sums.emplace_back(sum, static_cast<Eigen::Index>(i));
        }
        if (sums.empty()) return;
        const bool moves = sMoves_ || pMoves_;
        for (const auto& [sum, row] : sums)
            define(sum.text, sum.moves, sum.moves ? "@still(0.0)" : "0.0");
        const std::string m = "m" + std::to_string(group.outputs.front());
        for (std::size_t t = 0; t < group.terms.size(); ++t) {
            const Expression product = monomial(group.terms[t]);
            const bool mustBeMade = moves && !product.moves;
            std::string statement = (t == 0 ? typeOf(moves) + " " : std::string()) + m + " = " +
                                    (mustBeMade ? "@still(" + product.text + ")" : product.text) +
                                    ";";
            for (const auto& [sum, row] : sums)
                statement += " " + sum.text + " += " +
                             literal(group.coefficients(row, static_cast<Eigen::Index>(t))) +
                             " * " + m + (moves && !sum.moves ? ".VALUE" : "") + ";";
            line(statement);
        }
    }

    void writeVectors() {
        for (const CodeOutput& wanted : wanted_) {
            if (!isVector(wanted.index)) continue;
            const std::string axis = wanted.index % 2 == 0 ? "x" : "y";
            const int even = wanted.index - wanted.index % 2;
            const Expression alongS = sumOf(even) * Expression{axis + "s", sMoves_};
            const Expression alongP = sumOf(even + 1) * Expression{axis + "p", pMoves_};
            define(wanted.name, alongS.moves, alongS.text + " + " + alongP.text);
        }
    }

    const SparsePolynomial& polynomial_;
    bool isAxial_, sMoves_, pMoves_;
    const std::vector<CodeOutput>& wanted_;
    std::array<Expression, 5> variables_;
    std::string text_;
};

}  // namespace

std::string polynomialCode(const SparsePolynomial& polynomial, Moving moving,
                           const std::vector<CodeOutput>& wanted) {
    return PolynomialText(polynomial, moving, wanted).text();
}

}  // namespace etendue
