"""Looking ahead in momentum: what the law `receding-horizon` is made of.

`path` says which momenta the array is to go through, `knots` what can be done about each of them
(compiled), `program` makes the quadratic program of a whole plan, `seeds` finds plans to start
from, `plan` improves and compares them.
"""
