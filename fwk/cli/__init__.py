"""Commands that people type: `fwk-launch` and `fwk`.

Both start processes that compute, so linear algebra is limited here, before any command imports numpy.
"""

from fwk.model.linear_algebra import limit_threads

limit_threads()
