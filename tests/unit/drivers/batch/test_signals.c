/* SPDX-License-Identifier: BSD-3-Clause */
/* signals.c: what is asked for is noted. */
#include "unit/close.h"

#include <signal.h>

#include "signals.h"

TEST(a_checkpoint_is_wanted_once)
{
    requests *noted = signals_requests();
    assert_false(requests_checkpoint(noted));
    assert_int_equal(raise(SIGUSR1), 0);
    assert_true(requests_checkpoint(noted));
    assert_false(requests_checkpoint(noted));
    assert_null(requests_end(noted));
}

TEST(the_signal_that_asks_for_the_end_is_named)
{
    static const struct {
        int number;
        const char *name;
    } all[] = {{SIGTERM, "SIGTERM"}, {SIGINT, "SIGINT"}, {SIGXCPU, "SIGXCPU"}, {SIGUSR2, "SIGUSR2"}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        assert_int_equal(raise(all[k].number), 0);
        assert_string_equal(requests_end(signals_requests()), all[k].name);
    }
    assert_int_equal(raise(SIGPIPE), 0); /* is survived */
    assert_int_equal(raise(SIGXFSZ), 0);
}

TEST(what_is_ignored_stays_so)
{
    struct sigaction now;
    assert_true(signal(SIGINT, SIG_IGN) != SIG_ERR);
    signals_catch_end();
    assert_int_equal(sigaction(SIGINT, NULL, &now), 0);
    assert_true(now.sa_handler == SIG_IGN);
}

int main(void)
{
    signals_catch();
    signals_catch_end();
    return test_run();
}
