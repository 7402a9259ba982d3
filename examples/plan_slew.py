"""Plan null motion for a whole slew, prove that it is the best on its grid, and fly it."""

from nullmotion import plan
from nullmotion.plan import costs

SCENARIO = "papakonstantinou-roll"


def main() -> None:
    """Search by several methods and costs."""
    for method in ("skip", "exact"):
        found = plan.search(SCENARIO, method)
        print(
            f"{method:8s} cost {found.value:.4f} (without null motion {found.baseline_value:.4f}), "
            f"{found.rollouts:.0f} rollouts, proven: {found.proven}"
        )
        print("         knots", [int(k) for k in found.knots])

    fine = plan.search(SCENARIO, levels=7)
    print(f"7 levels cost {fine.value:.4f}, proven: {fine.proven}")
    print("         knots", [round(k, 2) for k in fine.knots])

    for name in costs.names():
        found = plan.search(SCENARIO, cost=name, depth=6)
        print(f"{name:20s} {found.baseline_value:9.4f} -> {found.value:9.4f}")


if __name__ == "__main__":
    main()
