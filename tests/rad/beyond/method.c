/* Tests of method_of() of rad/method.h: each ablation exchanges its own entries and no
 * other. */
#include "rad/model.h"

#include "tests/tap.h"

/* One bit for each entry that differs. */
static unsigned difference(const struct method *a, const struct method *b)
{
    return (unsigned)(a->light_power != b->light_power) |
           (unsigned)(a->first_link != b->first_link) << 1 |
           (unsigned)(a->node_child != b->node_child) << 2 |
           (unsigned)(a->make_link != b->make_link) << 3 |
           (unsigned)(a->side_to_split != b->side_to_split) << 4 |
           (unsigned)(a->split_link != b->split_link) << 5 |
           (unsigned)(a->keep_link != b->keep_link) << 6 |
           (unsigned)(a->divide != b->divide) << 6 |
           (unsigned)(a->transfer != b->transfer) << 7;
}

static void test(enum oracle oracle, enum form_factor form_factor,
                 enum linking_kind linking, const struct method *from, unsigned expected,
                 const char *name)
{
    struct criterion criterion = {
        .oracle = oracle, .form_factor = form_factor, .linking = linking};
    struct method method = method_of(&criterion);
    tap_ok(difference(&method, from) == expected, "%s", name);
}

int main(void)
{
    test(ORACLE_BF, FORM_FACTOR_DISK, LINKING_PAIRS, &PAPER, 0, "the paper's");
    test(ORACLE_ERROR, FORM_FACTOR_POLYGON, LINKING_TREE, &DEFAULT, 0, "the default");
    test(ORACLE_BF, FORM_FACTOR_POLYGON, LINKING_TREE, &DEFAULT, 0x10,
         "--oracle bf: the links that are split");
    test(ORACLE_ERROR, FORM_FACTOR_DISK, LINKING_TREE, &DEFAULT, 0x08,
         "--form-factor disk: the kernel");
    test(ORACLE_ERROR, FORM_FACTOR_POLYGON, LINKING_PAIRS, &DEFAULT, 0x03,
         "--linking pairs: the first links, and the unit of epsilon");
    test(ORACLE_BF, FORM_FACTOR_DISK, LINKING_TREE, &DEFAULT, 0x18, "two at a time");
    tap_ok(difference(&PAPER, &DEFAULT) == 0xff, "the two have no entry in common");
    return tap_done();
}
