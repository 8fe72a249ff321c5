"""What others have computed or proved, beside what this program gives.

`statements` holds what is compared and computes this program's side; `__main__` prints the
table of docs/literature.md. Where a statement was read is on that page.
"""
