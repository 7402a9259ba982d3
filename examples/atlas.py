"""Where an array is singular, what it can rely on, and a page to turn it in."""
