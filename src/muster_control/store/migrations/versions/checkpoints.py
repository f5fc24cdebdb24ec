"""The tables of checkpoints, and of where bodies are."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    op.create_table(
        "checkpoints",
        sa.Column("run", sa.Integer, sa.ForeignKey("runs.id", name="fk_checkpoints_run_runs")),
        sa.Column("seq", sa.Integer),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.Column("facts", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("run", "seq", name="pk_checkpoints"),
    )
    op.create_table(
        "bodies",
        sa.Column("run", sa.Integer, sa.ForeignKey("runs.id", name="fk_bodies_run_runs")),
        sa.Column("data", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("run", name="pk_bodies"),
    )
