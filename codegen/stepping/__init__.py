"""Models stepped from outside: runs that pause, and go on under inputs that are told then."""
